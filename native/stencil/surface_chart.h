// SPDX-License-Identifier: GPL-3.0-or-later
// Charts of single points in the metric of a surface in space; the control metric
// (stencil/metric.h) has only that of the control faces.
#pragma once

#include <cstdint>
#include <span>

#include "stencil/chart.h"

namespace fairing {

// One ring in space, counter-clockwise.
struct SpaceRing {
  std::span<const Vec3> offset;       // of the neighbours from the point, at unit grid spacing
  std::span<const std::uint8_t> far;  // whether they lie across a quad
  std::size_t first = 0;              // start of an open ring
  bool closed = true;
};

// Unfolds the ring with lengths raised to `exponent` as in flatten(): every triangle of the point
// and two neighbours is flattened with these. Neighbours are in the order of the ring. False if the
// ring is degenerate; the chart is then invalid.
bool chart_in_space(const SpaceRing& ring, double exponent, Chart& chart);

}  // namespace fairing
