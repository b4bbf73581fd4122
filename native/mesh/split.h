// SPDX-License-Identifier: GPL-3.0-or-later
// Splits polygons into triangles and quads by shape, never by index order, so that neither the
// order of faces nor a face's first corner changes the surface.
#pragma once

#include <array>
#include <vector>

#include "base/types.h"
#include "mesh/polygon_mesh.h"

namespace fairing {

struct SplitFace {
  std::array<Index, 4> vertex;  // counter-clockwise; vertex[3] == -1 for a triangle
  Index polygon;                // the face that it is part of
};

struct SplitMesh {
  std::vector<SplitFace> faces;  // in the order of their polygons
  std::vector<Vec3> centres;     // free vertices, numbered on from the input's
};

// * Polygons of five and more sides that are star-shaped about their area centroid become a fan
//   around a free vertex there; others are cut by their best triangulation (mesh/polygon_shape.h).
// * Quads with an angle over 170°, quads that fold by more than 60°, and quads with a vertex that
//   has only one other face are cut along the better diagonal, or into a fan if neither is better.
// * No diagonal joins two vertices that an edge joins already, or that two faces would join. So the
//   result is a manifold, no interior vertex has fewer than three faces, and the order of faces
//   does not matter. Where sheets meet, this holds for all of them together: otherwise two sheets could
//   have a triangle of the same three vertices, between which curves leave no room.
//
// `mesh` must have passed check() and be oriented, except for one-sided sheets; its last vertices
// are copies of `copied`. Throws FairingError(too_large) for polygons of more than 1000 corners
// that are not star-shaped.
SplitMesh split_polygons(const PolygonMesh& mesh, std::span<const Index> copied = {});

}  // namespace fairing
