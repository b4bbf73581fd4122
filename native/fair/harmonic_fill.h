// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "lattice/accumulate.h"

namespace fairing {

// Gives the marked points (above zero), where they are unknowns, the places of the surface x that are harmonic by the mean
// value weights (Floater 2003) of `shape`; all others stay. Weights are positive and take linear maps of a flat `shape`
// to themselves, so that where the surface around is not folded, neither is the filling. 3 numbers a point.
void fill_harmonically(const Lattice& lattice, const Unknowns& unknowns, const Array<float>& marks,
                       const double* shape, double* x);

}  // namespace fairing
