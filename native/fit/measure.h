// SPDX-License-Identifier: GPL-3.0-or-later
// The report of a fit.
#pragma once

#include "fit/fit_scan.h"
#include "fit/level_fit.h"

namespace fairing {

// The 95 % quantile of the offsets of feet that are used; working units.
double covered_within(const Array<Foot>& feet);

// Of one cell of the surface x, 3 numbers a point.
double cell_area(const Cells& cells, const double* x, Index cell);

// Sets distances, noise, coverage, faces that are too coarse, and outliers.
void measure_fit(const LevelFit& fit, const FairingProblem& problem, FitReport& report);

}  // namespace fairing
