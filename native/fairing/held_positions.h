// SPDX-License-Identifier: GPL-3.0-or-later
// Whether the surface passes through the control vertices or through their limit positions, and in
// the latter case whether the distance of the plate from the limit surface is penalized.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "fairing/options.h"
#include "grid/limit_surface.h"
#include "mesh/control_mesh.h"

namespace fairing {

struct HeldPositions {
  std::shared_ptr<const CatmullClark> limits{};   // to limit positions; null: the vertices stay
  std::shared_ptr<const LimitSurface> surface{};  // if the distance from it is penalized

  // The positions to hold for other positions of the input's vertices, 3 numbers each.
  std::vector<double> of(std::span<const double> coordinates) const;
};

struct HeldMesh {
  HeldPositions rule{};
  std::vector<Vec3> world{};  // per control vertex: the input's, their copies, centres
};

// Throws FairingError if limit positions of `input` are degenerate.
void check_held(const HeldPositions& held, const PolygonMesh& input, Repair repair);

// `mesh` is made from `input`. Throws FairingError if limit positions are degenerate.
HeldMesh held_positions(const PolygonMesh& input, const ControlMesh& mesh,
                        const FairOptions& options);

}  // namespace fairing
