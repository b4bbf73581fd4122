// SPDX-License-Identifier: GPL-3.0-or-later
#include "fairing/whole.h"

#include <cmath>

#include "constraints/control_constraints.h"
#include "stencil/membrane.h"
#include "stencil/metric.h"

namespace fairing {

MeshUnits measure_units(const ControlMesh& mesh, double exponent) {
  const std::vector<FlatFace> flat = flatten(mesh, exponent);
  return {mean_edge(mesh, flat), mean_edge(mesh, flatten(mesh, 1)), weight_unit(mesh, flat),
          weight_unit(mesh)};
}

MeshUnits in_lengths_of(const MeshUnits& units, double scale, double exponent) {
  const double length = std::pow(scale, exponent);
  return {units.edge / length, units.edge_in_space / scale, units.weight * length * length,
          units.weight_in_space * scale * scale};
}

}  // namespace fairing
