// SPDX-License-Identifier: GPL-3.0-or-later
#include "fairing/mesh_units.h"

#include "constraints/control_constraints.h"
#include "stencil/membrane.h"
#include "stencil/metric.h"

namespace fairing {

MeshUnits measure_units(const ControlMesh& mesh, double exponent) {
  const std::vector<FlatFace> flat = flatten(mesh, exponent);
  return {mean_edge(mesh, flat), mean_edge(mesh, flatten(mesh, 1)), weight_unit(mesh, flat),
          weight_unit(mesh)};
}

}  // namespace fairing
