// SPDX-License-Identifier: GPL-3.0-or-later
// What patches are fitted to: their sides, and the points of the lattice inside them.
#pragma once

#include "splines/curve_fit.h"
#include "splines/patch_fit.h"
#include "splines/topology.h"

namespace fairing {

// Sides are those parts of `curves`, in their own spans. Of the lattice's points so many are fitted
// as the spans of each direction need; all are measured.
PatchData patch_data(const Lattice& lattice, const Topology& topology, const PatchPlace& place,
                     const std::vector<FittedCurve>& curves);
void choose_fitted(const Lattice& lattice, const PatchPlace& place, int spans_u, int spans_v,
                   PatchData& data);

// A curve's parameter at t of a side, and a side's at t of its curve.
double on_curve(const PatchSide& side, double t);
double on_side(const PatchSide& side, double t);

}  // namespace fairing
