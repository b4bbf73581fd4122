// SPDX-License-Identifier: GPL-3.0-or-later
// A condition of third order at borders. The plate ends free at a curve, so no moment crosses it.
// If a shape bends on its border as it does next to it, the first rows of vertices carry loads
// instead, which do not indicate strain. With the moment of the first row applied to the curve, a
// shape that bends evenly has no loads there.
#pragma once

#include <span>
#include <vector>

#include "constraints/pads.h"
#include "grid/accumulate.h"
#include "stencil/chart.h"

namespace fairing {

// The moments on both sides of all smoothed curves: forces on the points next to them, 3 numbers a
// point of the level; empty if no control vertex on a pad is next to a curve. The bending of a
// vertex across the curve is the median of its own and that of its two neighbours along the curve,
// so that a single vertex with an error neither causes the moment nor is hidden by it. `positions`
// of all control vertices are in working coordinates.
std::vector<double> border_moments(const GridLevel& grid, const ChartMaker& charts,
                                   const Pads& pads, const Unknowns& unknowns,
                                   std::span<const Vec3> positions);

}  // namespace fairing
