// SPDX-License-Identifier: GPL-3.0-or-later
// The data of patch fits: their sides, and the points of the lattice inside them.
#pragma once

#include "splines/curve_fit.h"
#include "splines/patch_fit.h"
#include "splines/topology.h"

namespace fairing {

// Sides are the parts of `curves` that belong to the patch, with their spans. As many points of the
// lattice are fitted as the spans of each direction require; all are measured.
PatchData patch_data(const Lattice& lattice, const Topology& topology, const PatchPlace& place,
                     const std::vector<FittedCurve>& curves);
void choose_fitted(const Lattice& lattice, const PatchPlace& place, int spans_u, int spans_v,
                   PatchData& data);

// The parameter of a curve at t of a side, and that of a side at t of its curve.
double on_curve(const PatchSide& side, double t);
double on_side(const PatchSide& side, double t);

}  // namespace fairing
