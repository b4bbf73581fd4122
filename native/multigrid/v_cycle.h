// SPDX-License-Identifier: GPL-3.0-or-later
// The V-cycle as a preconditioner, and the coarsest solver.
#pragma once

#include <bit>
#include <memory>
#include <vector>

#include "multigrid/chebyshev.h"
#include "parallel/workers.h"
#include "transfer/level_transfer.h"

namespace fairing {

// The solver of the coarsest level: a sparse Cholesky factorization if the level is small enough,
// otherwise a fixed number of Chebyshev steps (interpolated control vertices keep the system
// well-conditioned, whatever their number).
//
// A factorization throws FairingError(underdetermined) if the matrix is singular, and bad_alloc.
class CoarseSolver {
 public:
  CoarseSolver(LevelOperator& op, Workers& workers, std::size_t unknowns, bool always_direct);
  ~CoarseSolver();

  // Whether K has changed since it was factored.
  bool is_old() const { return direct() && factored_ != op_.version().numbers; }
  void refactor();

  std::size_t size() const { return op_.size(); }  // of a vector
  bool direct() const { return factor_ != nullptr; }

  // state.x <- (approximately) K^-1 state.residual. The same linear map on every call.
  void solve(const LineJacobi* lines, double largest_eigenvalue, int degree, SmootherState& state);
  // x <- K^-1 b in double; direct() only.
  void solve(const double* b, double* x) const;
  // |D x|, D the diagonal of K: the size of the terms of products with x.
  double norm_of_terms(const double* x) const;

 private:
  struct Factor;
  bool factors();

  LevelOperator& op_;
  Workers& workers_;
  std::unique_ptr<Factor> factor_;
  int factored_ = 0;  // the version of its numbers
  std::size_t factor_bytes_ = 0;
};

// Largest levels, in unknowns, that are factored: the coarsest; any other, if thin faces make
// smoothing slow. They balance a factor's time, which grows faster than the unknowns, with that of
// smoothing; the first is small because factoring has one thread. The second needs 1.2 GB; a case
// of 783,000 unknowns took 72 s factored and 74 smoothed.
constexpr std::size_t direct_limit = 6000, direct_limit_of_hard = 500000;

// Approximate size of a factor of so many unknowns of a plate. Minimum degree leaves some 40 + 4
// log2 n entries a column.
constexpr std::size_t factor_bytes(std::size_t unknowns) {
  return matrix_entry * unknowns * (40 + 4 * std::size_t(std::bit_width(unknowns)));
}

// One level of the cycle.
struct CycleLevel {
  LevelOperator* op = nullptr;
  LevelTransfer* transfer = nullptr;  // to the next coarser level; null on the coarsest
  std::unique_ptr<LineJacobi> lines;  // of the smoother; null: not yet sought
  double largest_eigenvalue = 0;      // 0: unknown
  double work = 0;                    // iterations times degree, in solves of this K
  OperatorVersion version{};          // the version of the lines
  int spectrum = 0;  // the version of the eigenvalue: counted on all levels up to this one
  SmootherState state{};
  std::size_t unknowns = 0;
};

// The V-cycle as a preconditioner, in single precision: one linear map, with restriction the
// transpose of prolongation. With the same smoother before and after the coarse correction it is
// symmetric positive definite.
class VCycle {
 public:
  explicit VCycle(Workers& workers) : workers_(workers) {}

  std::vector<CycleLevel> levels;        // coarsest first
  std::unique_ptr<CoarseSolver> coarse;  // of levels[base]
  std::size_t base = 0;
  int degree = 0;  // of the smoother, before and after

  // Whether a cycle on that level is a direct solve.
  bool solves(std::size_t top) const { return top == base && coarse->direct(); }

  // levels[top].state.x <- M^-1 levels[top].state.residual; the residual is overwritten. Throws
  // where the run has been cancelled.
  void run(std::size_t top) { run(top, degree, degree); }
  // With other degrees, at least one, before and after. ScopedExchange, they give the transpose.
  void run(std::size_t top, int before, int after);

 private:
  Workers& workers_;
};

}  // namespace fairing
