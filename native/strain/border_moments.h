// SPDX-License-Identifier: GPL-3.0-or-later
// A border's condition of third order. The plate ends free at a curve, so no moment crosses it, and
// where a shape bends on its border as it does beside it, the first rows of vertices are loaded in
// its place. That says nothing of them. With the moment of the first row on the curve too, a shape
// that bends evenly there has no loads.
#pragma once

#include <span>
#include <vector>

#include "constraints/pads.h"
#include "grid/accumulate.h"
#include "stencil/chart.h"

namespace fairing {

// What turns the sheets on both sides of all smoothed curves: forces on the points beside them, 3
// numbers a point of the level; empty where no control vertex on a pad is beside a curve. A vertex'
// bending across the curve is the median of its own and its two neighbours' along the curve, so that
// none that is out of line makes the moment, or hides behind it. `positions` of all control vertices,
// in working coordinates.
std::vector<double> border_moments(const GridLevel& grid, const ChartMaker& charts,
                                   const Pads& pads, const Unknowns& unknowns,
                                   std::span<const Vec3> positions);

}  // namespace fairing
