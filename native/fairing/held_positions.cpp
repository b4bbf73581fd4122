// SPDX-License-Identifier: GPL-3.0-or-later
#include "fairing/held_positions.h"

#include <string>
#include <utility>

#include "base/error.h"
#include "fairing/control_positions.h"
#include "mesh/validate/check.h"

namespace fairing {
namespace {

// Where limit positions fall together the charts would have no shape.
void check_limits(const PolygonMesh& limits, Repair repair) {
  try {
    check(limits, {repair == Repair::mend});
  } catch (const FairingError& error) {
    throw FairingError(error.code,
                       std::string("At the limit positions of the vertices: ") + error.what() +
                           " Or use a lower limit, or interpolation=\"exact\".",
                       error.elements, error.kind);
  }
}

}  // namespace

std::vector<double> HeldPositions::of(std::span<const double> coordinates) const {
  if (at_limits) return limits.of(coordinates);
  return {coordinates.begin(), coordinates.end()};
}

HeldMesh held_positions(const PolygonMesh& input, const ControlMesh& mesh,
                        const FairOptions& options) {
  if (options.interpolation != Interpolation::limit) return {.world = mesh.positions};
  HeldPositions rule{true, LimitPositions(input, mesh, options.features.corner_vertices,
                                          options.sharpness, options.limit)};
  const std::vector<double> moved = rule.of(input.coordinates);
  check_limits({moved, input.corners, input.offsets}, options.repair);
  return {std::move(rule), all_positions(mesh, mesh.positions, moved)};
}

}  // namespace fairing
