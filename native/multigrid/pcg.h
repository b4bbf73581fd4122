// SPDX-License-Identifier: GPL-3.0-or-later
// Preconditioned conjugate gradients on one level.
#pragma once

#include <functional>
#include <vector>

#include "multigrid/v_cycle.h"

namespace fairing {

// Of the norm of a residual's terms: what is left of it below is rounding, some 20 units in the last
// place.
constexpr double rounding_of_terms = 2e-15;

struct PcgLimits {
  // Of the residual, relative to `residual_scale`, and of the error in the energy norm, relative to
  // `energy_scale`: residuals of fourth order hide the smooth part of an error.
  double tolerance = 1e-8;
  double residual_scale = 0;  // the residual of the control polyhedron on this level
  double energy_scale = 0;    // sqrt(energy)
  double noise = 0;           // a residual up to this is rounding, and relative to anything zero
  int max_iterations = 200;
  bool from_start = false;  // both scales are what the start has
  // The error alone is judged. Residuals of smooth loads are smooth: the first iterations add rough
  // ones, which are more than that though the error falls.
  bool by_error = false;
  // From the start, or to so much of the scales above, whichever comes first; 0: never the latter.
  double enough = 0;
  // Whether the caller can do with what there is at the end: then no level is factored, and the
  // smoother's degree stays low.
  bool may_end_early = false;
  // Whether the smoother may change on the way: not where how it goes says nothing of later solves.
  bool may_adapt = true;

  // A residual's norm as it is reported.
  double relative(double length, double scale) const {
    return length > noise && scale > 0 ? length / scale : 0.0;
  }
};

struct PcgResult {
  int iterations = 0;
  double residual = 0;      // relative to the scale, at the end
  double energy_error = 0;  // estimate of |error|_K / sqrt(energy), at the end
  bool converged = false;
  bool enough = false;                          // as PcgLimits::enough says
  bool broke_down = false;                      // rounding has left no way down
  double residual_scale = 0, energy_scale = 0;  // what both are relative to
  std::vector<double> history;                  // relative residual, the start's first
};

// A level's linear system K x = b, and how far it is solved.
struct LinearSystem {
  // r <- b - K x, in double. Solves call it last for the x that they end at, but where the iteration
  // itself is in double.
  std::function<void(const double* x, double* r)> residual;
  double* x;  // is improved in place
  double* r;  // b - K x of x as it is, which is overwritten
  // z <- S y, where K is nearly A S^-1 A, with the A that the cycle's levels apply in single
  // precision: a cycle, S, and that cycle's transpose precondition. Empty: A is K.
  std::function<void(const float* y, float* z)> between{};
};

// Work vectors of the conjugate gradients, kept between levels.
struct PcgState {
  Array<double> direction, product;                             // of iterations in double
  Array<float> rest, fast_direction, fast_product, correction;  // of those in single precision
};

// Preconditioned conjugate gradients on all components at once (one scalar system, so the iterates
// turn with the mesh). Where single precision does for the level they run in it, on a residual that
// is computed anew in double, from x, each time it has become a hundred times smaller [residual
// replacement: van der Vorst and Ye 2000]; so the limits hold in double. The flexible beta allows
// for a preconditioner of single precision, and for one that changes on the way: `each` may raise
// cycle.degree after an iteration; it returns false to stop. Ends unconverged at max_iterations, or
// where rounding leaves nothing to gain. Throws where the run has been cancelled.
PcgResult conjugate_gradients(VCycle& cycle, std::size_t top, Workers& workers,
                              const PcgLimits& limits, const LinearSystem& system, PcgState& state,
                              const std::function<bool(const PcgResult&)>& each);

}  // namespace fairing
