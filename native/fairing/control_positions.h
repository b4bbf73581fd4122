// SPDX-License-Identifier: GPL-3.0-or-later
// Where the control vertices and the points of feature curves are, in both coordinate systems.
//
// World coordinates are the caller's: positions and curves are computed in them, so that meshes
// that share vertices get the same points bit for bit. Working coordinates are what every solve
// uses: the mesh around the origin, of a size from one to two. Nothing here is ever converted in
// place, so a name says which system its numbers are in.
#pragma once

#include <span>
#include <vector>

#include "curves/feature_curves.h"
#include "fairing/whole.h"
#include "mesh/polygon_mesh.h"

namespace fairing {

// The map between the two: world = centre + scale * working. The scale is a power of two, so
// scaling is exact.
struct Frame {
  Vec3 centre = Vec3::Zero();
  double scale = 1;

  Vec3 to_working(const Vec3& world) const { return (world - centre) / scale; }
  Vec3 to_world(const Vec3& working) const { return centre + scale * working; }
};

// Centred on the bounding box of `world`, which has one position for each control vertex. Vertices
// without faces do not count.
Frame working_frame(const ControlMesh& mesh, std::span<const Vec3> world);

struct ControlPositions {
  // The positions through which the surface passes, one for each control vertex: those of the
  // input, their copies, centres of split polygons.
  std::vector<Vec3> world, working;
  // The caller's positions, one for each input vertex, in world coordinates. They differ from
  // `world` if the surface passes through limit positions.
  std::vector<Vec3> cage;
  FeatureCurves world_curves, working_curves;

  std::vector<Vec3> cage_in(const Frame& frame) const {
    std::vector<Vec3> out;
    for (const Vec3& p : cage) out.push_back(frame.to_working(p));
    return out;
  }
};

// The positions `world` themselves, which also give the parameters of the curves. `handed` curves are taken from the whole mesh; throws FairingError(bad_shape) if they have the wrong
// number of points.
ControlPositions positions_of_mesh(const ControlMesh& mesh, std::vector<Vec3> world,
                                   const Frame& frame, const CurveScheme& scheme,
                                   const HandedCurves& handed);

// Other positions of the input's vertices: `coordinates`, world, 3 numbers each. The result is
// linear in them: curve parameters and the weights of centres in their polygons are those of
// `basis_world`. Handed curves are those of the shape with this number.
ControlPositions positions_of_shape(const ControlMesh& mesh, std::span<const Vec3> basis_world,
                                    std::span<const double> coordinates, const Frame& frame,
                                    const CurveScheme& scheme, const HandedCurves& handed = {},
                                    std::size_t shape = 0);

// Extends `coordinates`, 3 numbers for each input vertex, to all control vertices: copies, and
// centres by their weights in `basis_world`.
std::vector<Vec3> all_positions(const ControlMesh& mesh, std::span<const Vec3> basis_world,
                                std::span<const double> coordinates);

// Throws FairingError: bad_shape if the numbers are not a multiple of those of one shape;
// non_finite, which names shape and vertices.
void check_shapes(const PolygonMesh& mesh, std::span<const double> shapes);

// Throws FairingError: bad_shape for a wrong number of coordinates; non_finite, which names the
// vertices.
void check_positions(std::size_t vertices, std::span<const double> coordinates);

}  // namespace fairing
