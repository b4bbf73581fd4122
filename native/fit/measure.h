// SPDX-License-Identifier: GPL-3.0-or-later
// How a surface fits its scan, in numbers for the caller.
#pragma once

#include "fit/fit_scan.h"
#include "fit/level_fit.h"

namespace fairing {

// What 95 % of the offsets of feet that pull are within; working units.
double covered_within(const Array<Foot>& feet);

// Of one cell of the surface x, 3 numbers a point.
double cell_area(const Cells& cells, const double* x, Index cell);
double surface_area(const Cells& cells, const double* x);

// Distances, noise, coverage, faces that are too coarse, outliers.
void measure_fit(const LevelFit& fit, const FairingProblem& problem, FitReport& report);

}  // namespace fairing
