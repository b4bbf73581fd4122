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

// The map between the two: world = centre + scale * working. The scale is a power of two, so it
// costs no digit, and single precision meets no tiny or huge unit.
struct Frame {
  Vec3 centre = Vec3::Zero();
  double scale = 1;

  Vec3 to_working(const Vec3& world) const { return (world - centre) / scale; }
  Vec3 to_world(const Vec3& working) const { return centre + scale * working; }
};

// Centred on the bounding box of `world`, one position a control vertex; vertices without faces
// do not count.
Frame working_frame(const ControlMesh& mesh, std::span<const Vec3> world);

struct ControlPositions {
  // Where the surface is held. One a control vertex: the input's, copies of them, centres of split
  // polygons.
  std::vector<Vec3> world, working;
  // The caller's own, one an input vertex, in world coordinates: others than `world` where the
  // surface passes through limit positions.
  std::vector<Vec3> cage;
  FeatureCurves world_curves, working_curves;

  std::vector<Vec3> cage_in(const Frame& frame) const {
    std::vector<Vec3> out;
    for (const Vec3& p : cage) out.push_back(frame.to_working(p));
    return out;
  }
};

// Of `world` itself: the parameters of curves are those of these positions. `subdivisions`: 2^L
// for the finest level L. `exponent`: of the control metric (stencil/metric.h). Curves that are
// `handed` down are as the whole has them. Throws FairingError(bad_shape) where their points are not
// as many as that takes.
ControlPositions positions_of_mesh(const ControlMesh& mesh, std::vector<Vec3> world,
                                   const Frame& frame, int subdivisions, double exponent,
                                   const HandedCurves& handed);

// Of other positions of the input's vertices: `coordinates`, in world coordinates, 3 a vertex. A
// linear map of them: the parameters of curves and the centres' weights in their polygons are
// those of `basis_world`. Handed curves are those of the shape with this number.
ControlPositions positions_of_shape(const ControlMesh& mesh, std::span<const Vec3> basis_world,
                                    std::span<const double> coordinates, const Frame& frame,
                                    int subdivisions, double exponent,
                                    const HandedCurves& handed = {}, std::size_t shape = 0);

// `coordinates`, 3 numbers an input vertex, as positions of all control vertices: copies and centres
// follow, the latter by their weights in `basis_world`.
std::vector<Vec3> all_positions(const ControlMesh& mesh, std::span<const Vec3> basis_world,
                                std::span<const double> coordinates);

// Throws FairingError: bad_shape when the coordinates do not come to whole shapes of the mesh;
// non_finite, naming the shape and the vertices.
void check_shapes(const PolygonMesh& mesh, std::span<const double> shapes);

// Throws FairingError: bad_shape when the coordinates are not those of so many vertices;
// non_finite, naming the vertices.
void check_positions(std::size_t vertices, std::span<const double> coordinates);

}  // namespace fairing
