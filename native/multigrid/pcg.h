// SPDX-License-Identifier: GPL-3.0-or-later
// Preconditioned conjugate gradients on one level.
#pragma once

#include <functional>
#include <vector>

#include "multigrid/v_cycle.h"

namespace fairing {

// Relative to the norm of a residual's terms: below this a residual is rounding, some 20 units in
// the last place.
constexpr double roundoff_of_terms = 2e-15;

struct PcgLimits {
  // Of the residual, relative to `residual_scale`, and of the error in the energy norm, relative to
  // `energy_scale`: residuals of fourth order hide the smooth part of an error.
  double tolerance = 0;
  double residual_scale = 0;  // the residual of the control polyhedron on this level
  double energy_scale = 0;    // sqrt(energy)
  double noise = 0;           // a residual up to this is rounding and counts as zero
  int max_iterations = 200;
  bool from_start = false;  // both scales are those of the start
  // Tests the error alone. Residuals of smooth loads are smooth: the first iterations add rough
  // ones, which are larger although the error falls.
  bool by_error = false;
  // Stops at this share of the scales above, if that comes before `tolerance` relative to the
  // start; 0: never.
  double enough = 0;
  // Whether the caller can use an inaccurate result: then no level is factored, and the smoother's
  // degree stays low.
  bool may_end_early = false;
  // Whether the smoother may change: not if this solve is not representative of later ones.
  bool may_adapt = true;

  // A residual's norm as reported.
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
  bool broke_down = false;                      // rounding prevents progress
  double residual_scale = 0, energy_scale = 0;  // to which both are relative
  std::vector<double> history;                  // relative residual, the start's first
  std::vector<double> seen;  // the same in the preconditioner's norm, sqrt(r M^-1 r); not the end's
};

// A level's linear system K x = b.
struct LinearSystem {
  // r <- b - K x, for direct solves.
  std::function<void(const double* x, double* r)> residual;
  double* x;  // improved in place
  double* r;  // b - K x for the initial x; overwritten
  // z <- S y, where K is approximately A S^-1 A with the A that the cycle's levels apply in single
  // precision: a cycle, S, and that cycle's transpose precondition. Empty: A is K.
  std::function<void(const float* y, float* z)> between{};
  // Called after every iteration; or empty.
  std::function<void(const PcgResult&)> watch{};
};

// Work vectors of the conjugate gradients, kept between levels.
struct PcgState {
  Array<double> direction, product;
};

// Preconditioned conjugate gradients on all components at once (one scalar system, so the iterates
// rotate with the mesh), in double. The flexible beta allows a preconditioner in single precision,
// and one that changes: `each` may raise cycle.degree after an iteration; it returns false to stop.
// Ends unconverged at max_iterations, or if rounding prevents progress. Throws
// FairingError(cancelled).
PcgResult conjugate_gradients(VCycle& cycle, std::size_t top, Workers& workers,
                              const PcgLimits& limits, const LinearSystem& system, PcgState& state,
                              const std::function<bool(const PcgResult&)>& each);

}  // namespace fairing
