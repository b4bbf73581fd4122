// SPDX-License-Identifier: GPL-3.0-or-later
// Units of the settings.
#pragma once

#include "mesh/control_mesh.h"

namespace fairing {

// Mean edge lengths and weight_unit() (constraints/control_constraints.h), in the metric of the
// charts and in space.
struct MeshUnits {
  double edge = 1, edge_in_space = 1;
  double weight = 1, weight_in_space = 1;
};

// In the unit of the mesh. `exponent`: of the metric.
MeshUnits measure_units(const ControlMesh& mesh, double exponent);

}  // namespace fairing
