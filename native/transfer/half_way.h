// SPDX-License-Identifier: GPL-3.0-or-later
// The numbers of the prolongation (transfer.h).
#pragma once

namespace fairing {

// Half-way to a neighbour, the parabola through f(-1), f(0), f(1) is 3/8 f(1) + 3/4 f(0) - 1/8 f(-1).
constexpr double ahead = 0.375, here = 0.75, behind = -0.125;

// What a fit's value half-way to a neighbour counts for: half of an edge's midpoint, a quarter of a quad's centre.
constexpr double of_midpoint = 0.5, of_centre = 0.25;

}  // namespace fairing
