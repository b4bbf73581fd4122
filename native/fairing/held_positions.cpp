// SPDX-License-Identifier: GPL-3.0-or-later
#include "fairing/held_positions.h"

#include <string>
#include <utility>

#include "base/error.h"
#include "fairing/control_positions.h"
#include "mesh/validate/check.h"

namespace fairing {
std::vector<double> HeldPositions::of(std::span<const double> coordinates) const {
  if (limits) return limits->vertex_limits(coordinates);
  return {coordinates.begin(), coordinates.end()};
}

// Coincident limit positions would give charts without a shape.
void check_held(const HeldPositions& held, const PolygonMesh& input, Repair repair) {
  if (!held.limits) return;
  const std::vector<double> limits = held.of(input.coordinates);
  try {
    check({limits, input.corners, input.offsets}, {repair == Repair::mend});
  } catch (const FairingError& error) {
    throw FairingError(error.code,
                       {"At the limit positions of the vertices: " + error.message.cause,
                        error.message.cure + " Or use interpolation=\"exact\"."},
                       error.elements, error.kind);
  }
}

HeldMesh held_positions(const PolygonMesh& input, const ControlMesh& mesh,
                        const FairOptions& options) {
  if (options.interpolation != Interpolation::limit) return {.world = mesh.positions};
  const SharpRules rules(mesh, options.features.corner_vertices, options.sharpness);
  const int steps = LimitSurface::steps(mesh, options.levels);
  HeldPositions rule{std::make_shared<CatmullClark>(input, mesh, rules, steps)};
  rule.surface = std::make_shared<LimitSurface>(rule.limits, mesh);
  check_held(rule, input, options.repair);
  const std::vector<double> moved = rule.of(input.coordinates);
  return {std::move(rule), all_positions(mesh, mesh.positions, moved)};
}

}  // namespace fairing
