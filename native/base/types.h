// SPDX-License-Identifier: GPL-3.0-or-later
// The numbers that all rooms speak in. Positions and lengths have the unit of the caller's mesh, or
// of the working frame that fairing/control_positions.h makes of it; angles are in radians.
#pragma once

#include <Eigen/Core>
#include <cstdint>

namespace fairing {

// Of points, edges and faces, on any level; -1: none. check() refuses what 32 bits cannot number.
using Index = std::int32_t;
using Vec2 = Eigen::Vector2d;
using Vec3 = Eigen::Vector3d;

}  // namespace fairing
