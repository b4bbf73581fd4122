// SPDX-License-Identifier: GPL-3.0-or-later
// Where the control vertices and the points of curves of a surface are: of the mesh itself, or of a shape.
#pragma once

#include "curve/feature_curves.h"
#include "fair/frame.h"
#include "fair/options.h"

namespace fairing {

struct Placement {
  std::vector<Vec3> world, working;  // per control vertex, centres of split polygons too
  FeatureCurves world_curves, working_curves;
};

// Throws FairingError: bad_shape for coordinates that do not come to whole shapes; non_finite, naming shape and
// vertices.
void check_shapes(const PolygonMesh& mesh, std::span<const double> shapes);

// The same for the positions of one surface: other ones than `vertices` many, or not finite.
void check_positions(std::size_t vertices, std::span<const double> coordinates);

// Everything here takes a mesh whose positions are in world coordinates.
Placement place_basis(const ControlMesh& mesh, const Frame& frame, int subdivisions, double exponent);

// A linear map of the coordinates: parameters of curves and centres of polygons are those of the mesh.
Placement place_shape(const ControlMesh& mesh, std::span<const double> coordinates, const Frame& frame,
                      int subdivisions, double exponent);

}  // namespace fairing
