// SPDX-License-Identifier: GPL-3.0-or-later
// Number types of the core. Positions and lengths are in the unit of the caller's mesh, or of the
// working frame (fairing/control_positions.h); angles are in radians.
#pragma once

#include <Eigen/Core>
#include <cstdint>

namespace fairing {

// Index of a point, edge or face on any level; -1: none. check() refuses meshes that 32 bits cannot
// number.
using Index = std::int32_t;
using Vec2 = Eigen::Vector2d;
using Vec3 = Eigen::Vector3d;

}  // namespace fairing
