// SPDX-License-Identifier: GPL-3.0-or-later
// Quantities of a whole mesh that a piece would find differently. A piece is faired as a mesh of
// its own with these.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "mesh/control_mesh.h"

namespace fairing {

// Units of the settings: mean edge lengths and weight_unit() (constraints/control_constraints.h),
// in the metric of the charts and in space.
struct MeshUnits {
  double edge = 1, edge_in_space = 1;
  double weight = 1, weight_in_space = 1;
};

// In the unit of the mesh. `exponent`: of the metric.
MeshUnits measure_units(const ControlMesh& mesh, double exponent);
// With all lengths divided by `scale`.
MeshUnits in_lengths_of(const MeshUnits& units, double scale, double exponent);

// Refined curves, edge by edge, because a chain continues beyond a piece.
struct HandedCurves {
  std::vector<std::array<std::int64_t, 2>> edges;  // vertex pairs of the input
  // Points inside each edge, from its first vertex on, world, 3 numbers each: those of the mesh,
  // then of each shape.
  std::vector<double> points;
};

struct OfWhole {
  bool given = false;
  MeshUnits units{};
  HandedCurves curves{};
};

}  // namespace fairing
