// SPDX-License-Identifier: GPL-3.0-or-later
// Prolongation by local quadratics [Kobbelt 1997a]: a new point is the mean of the fits at its two ends (a quad's
// centre: at its four corners), evaluated in their charts. Inside a face the fits along a lattice line are the parabola
// of three points; points of curves, which carry no fit, give linear values. Restriction is the transpose.
#pragma once

#include "difference/stencils.h"
#include "lattice/accumulate.h"

namespace fairing {

// fine <- P coarse; zero on points that are not unknowns (every point counts when `unknowns` is null).
template <class T, int C>
void prolong(const Lattice& coarse, const Lattice& fine, const Stencils& stencils, const Unknowns* unknowns,
             Workers& workers, Exchange<T, C>& exchange, const T* x_coarse, T* x_fine);

// coarse <- P^T fine on the coarse unknowns, zero elsewhere.
template <class T, int C>
void restrict_to(const Lattice& coarse, const Lattice& fine, const Stencils& stencils,
                 const Unknowns& unknowns, Workers& workers, Exchange<T, C>& exchange, const T* x_fine,
                 T* x_coarse);

}  // namespace fairing
