// SPDX-License-Identifier: GPL-3.0-or-later
// What is one for a whole mesh, and what a piece of it would find otherwise. A piece is faired as a
// mesh of its own that is told this.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "mesh/control_mesh.h"

namespace fairing {

// What the settings' units are measured in: mean lengths of edges, and weight_unit()
// (constraints/control_constraints.h); in the metric of the charts, and in space.
struct MeshUnits {
  double edge = 1, edge_in_space = 1;
  double weight = 1, weight_in_space = 1;
};

// Of a mesh, in its unit of length. `exponent`: of the metric.
MeshUnits measure_units(const ControlMesh& mesh, double exponent);
// With lengths divided by `scale`.
MeshUnits in_lengths_of(const MeshUnits& units, double scale, double exponent);

// Refined curves, an edge at a time: a chain goes on where a piece ends.
struct HandedCurves {
  std::vector<std::array<std::int64_t, 2>> edges;  // vertex pairs of the input
  // Inside each edge, from its first vertex on; world, 3 numbers each: all those of the mesh, then
  // those of each shape.
  std::vector<double> points;
};

struct OfWhole {
  bool given = false;
  MeshUnits units{};
  HandedCurves curves{};
};

}  // namespace fairing
