// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "chart/chart.h"

namespace fairing {

// chart <- (1 - alpha) uniform + alpha chart [Kobbelt 1997b], after the uniform chart has been brought to the chart's
// mean radius and turned by the rotation that fits best: so the blend depends on no choice of a first neighbour.
void blend(const Chart& uniform, double alpha, Chart& chart);

}  // namespace fairing
