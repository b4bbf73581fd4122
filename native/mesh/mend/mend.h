// SPDX-License-Identifier: GPL-3.0-or-later
// Mends what can be mended of a mesh before check() sees it: repeated and coincident corners,
// duplicate faces, faces without area, faces that name absent vertices. Sheets that meet, and the way faces look, are not its
// business. The input is only read.
//
// Deterministic, and independent of the order of faces and corners but for ties, which the lowest
// id decides. Linear time up to sorting. May throw FairingError(cancelled) and std::bad_alloc.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "base/error.h"
#include "base/types.h"
#include "mesh/polygon_mesh.h"

namespace fairing {

struct MendOptions {
  // Vertices no farther apart than this become one: 0 those at one point, negative none.
  double weld = -1;
};

// Where a corner's values come from: (1 - share) of input corner `from` and `share` of `beside`.
struct CornerOrigin {
  Index from, beside;
  double share = 0;
};

// An edge of the input (low < high) that has got vertices in between, in order from low.
struct CutEdge {
  Index low, high;
  std::vector<Index> between;
};

struct MendedMesh {
  // Nothing was wrong: all that follows is empty.
  bool changed() const { return !acts.empty(); }

  // As many vertices as the input, in its order. One that was merged with another, or has no
  // position and no face, is where `vertex_origin` says, and belongs to no face.
  OwnedPolygonMesh mesh;
  std::vector<Index> vertex_origin;  // most often the vertex itself
  std::vector<Index> face_origin;    // the input face of every face, ascending
  std::vector<CornerOrigin> corner_origin;
  std::vector<CutEdge> cut_edges;  // ascending

  // What was done, each with all elements of the input concerned, in words.
  std::vector<Warning> acts;

  std::size_t bytes() const;

  // Other positions of the input's vertices, 3 numbers each, with those vertices moved along.
  std::vector<double> placed(std::span<const double> coordinates) const;
};

// Throws the first defect that stands in the way of mending.
void require_mendable(const PolygonMesh& mesh);

// Throws FairingError for what no program could mend: arrays that describe no faces, vertices of
// faces without a finite position, and no face left.
MendedMesh mend(const PolygonMesh& mesh, const MendOptions& options = {});

}  // namespace fairing
