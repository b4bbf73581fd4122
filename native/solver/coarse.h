// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>

#include "execution/workers.h"
#include "solver/chebyshev.h"

namespace fairing {

// The solver of the coarsest level: a sparse Cholesky factorization where the level is small enough, a fixed number of
// Chebyshev steps otherwise (interpolated control vertices keep the system well-conditioned, however many they are).
class CoarseSolver {
 public:
  CoarseSolver(LevelOperator& op, Workers& workers, std::size_t unknowns, bool always_direct);
  ~CoarseSolver();

  // Call after the operator has changed.
  void refactor();

  std::size_t size() const { return op_.size(); }  // of a vector
  bool direct() const { return factor_ != nullptr; }

  // state.x <- (approximately) K^-1 state.residual. The same linear map on every call.
  void solve(double largest_eigenvalue, int degree, SmootherState& state);
  // x <- K^-1 b in double; direct() only.
  void solve(const double* b, double* x) const;

 private:
  struct Factor;
  LevelOperator& op_;
  Workers& workers_;
  std::unique_ptr<Factor> factor_;
  std::size_t factor_bytes_ = 0;
};

// Largest coarsest level, in unknowns, that is factored; and where smoothing has proved hard, since its faces are thin.
constexpr std::size_t direct_limit = 6000, direct_limit_of_hard = 80000;
// The latter where a factor serves one right-hand side only.
constexpr std::size_t direct_limit_of_steps = 16000;

}  // namespace fairing
