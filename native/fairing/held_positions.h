// SPDX-License-Identifier: GPL-3.0-or-later
// Where a surface is held: at its control vertices, or at their limit positions. And where those are,
// whether the plate between them is drawn to the limit surface.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "fairing/options.h"
#include "grid/limit_surface.h"
#include "mesh/control_mesh.h"

namespace fairing {

struct HeldPositions {
  std::shared_ptr<const CatmullClark> limits{};   // at the limit positions of these; null: not so
  std::shared_ptr<const LimitSurface> surface{};  // where the thin plate is drawn to it

  // Of other positions of the input's vertices, 3 numbers each: where these are held.
  std::vector<double> of(std::span<const double> coordinates) const;
};

struct HeldMesh {
  HeldPositions rule{};
  std::vector<Vec3> world{};  // one a control vertex: the input's, copies of them, centres
};

// Throws FairingError where the vertices of `input` are held at limit positions that have no shape.
void check_held(const HeldPositions& held, const PolygonMesh& input, Repair repair);

// `mesh` is made of `input`. Throws FairingError where limit positions have no shape.
HeldMesh held_positions(const PolygonMesh& input, const ControlMesh& mesh,
                        const FairOptions& options);

}  // namespace fairing
