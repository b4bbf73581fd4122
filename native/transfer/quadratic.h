// SPDX-License-Identifier: GPL-3.0-or-later
// Prolongation by local quadratics [Kobbelt 1997a]: a new point is the mean of the fits at its two
// ends (a quad's centre: at its four corners), evaluated in their charts. Inside a face the fits
// along a grid line are the parabola of three points; points of curves have no fit and give linear
// values. Restriction is the transpose.
//
// T: float or double; C: numbers a point, 1 or 3. All functions throw FairingError(cancelled).
// Exact for quadratics in a chart, so of third order.
#pragma once

#include "grid/accumulate.h"
#include "stencil/stencils.h"

namespace fairing {

// Half-way to a neighbour, the parabola through f(-1), f(0), f(1) is
//
//   ahead f(1) + here f(0) + behind f(-1).
struct MidpointWeights {
  static constexpr double ahead = 0.375, here = 0.75, behind = -0.125;
};

// Weight of a fit's value half-way to a neighbour: half for an edge's midpoint, a quarter for a
// quad's centre.
constexpr double midpoint_share = 0.5, centre_share = 0.25;

// fine <- P coarse; zero on points that are not unknowns (all points count if `unknowns` is null).
template <class T, int C>
void prolong(const GridLevel& coarse, const GridLevel& fine, const Stencils& stencils,
             const Unknowns* unknowns, Workers& workers, ElementSlots<T, C>& slots,
             const T* x_coarse, T* x_fine);

// coarse <- P^T fine on the coarse unknowns, zero elsewhere.
template <class T, int C>
void restrict_to(const GridLevel& coarse, const GridLevel& fine, const Stencils& stencils,
                 const Unknowns& unknowns, Workers& workers, ElementSlots<T, C>& slots,
                 const T* x_fine, T* x_coarse);

}  // namespace fairing
