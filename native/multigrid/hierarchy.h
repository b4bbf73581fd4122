// SPDX-License-Identifier: GPL-3.0-or-later
// The operators of all levels, and linear solves on any of them: conjugate gradients around
// V-cycles, with a direct solve where the cycle ends. It adapts to what it meets: skew makes a mesh
// hard, on all levels alike; the smoother then works on blocks in place of the diagonal, its degree
// rises, and a level that stays hard is factored.
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "multigrid/pcg.h"
#include "multigrid/v_cycle.h"

namespace fairing {

// Levels up to so many unknowns are factored sooner than smoothed; the cycle ends on the finest of
// them.
constexpr std::size_t tiny_level = 1200;

struct HierarchyOptions {
  int smoother_degree = 0;     // 0: chosen from how the solves go
  bool always_factor = false;  // the coarsest level is ill-conditioned, however large
  bool may_block = false;      // whether the smoother may work on blocks (block_jacobi.h)
  // The operators change from solve to solve: each is judged alone. A level whose factor is cheap
  // is factored sooner than it takes blocks.
  bool operators_change = false;
  // Unknowns of a level up to which a factor costs little.
  std::size_t cheap_factor = direct_limit_of_hard;
  // From this level on, the coarsest being 0, the largest eigenvalue is that of the level below.
  std::size_t settled = 4;
};

// How a solve went.
struct LevelSolve {
  int iterations = 0;
  double residual = 0, energy_error = 0;  // at the end, as in PcgResult
  double largest_eigenvalue = 0;          // that the smoother worked with
  int smoother_degree = 0;                // at the end; 0: no smoother was asked
  bool direct = false, converged = false;
  bool enough = false;            // as PcgLimits::enough says
  bool blocks = false;            // whether the smoother worked on blocks
  std::vector<double> residuals;  // after 0, 1, … iterations
};

class Hierarchy {
 public:
  Hierarchy(Workers& workers, const HierarchyOptions& options);

  // Coarsest first; `to_coarser` is null for the first. All must outlive the hierarchy.
  void add(LevelOperator& op, LevelTransfer* to_coarser, std::size_t unknowns);
  // After the last add().
  void complete();

  const Array<float>& inverse_diagonal(std::size_t index) const {
    return cycle_.levels[index].op->inverse_diagonal();
  }
  // A vector of the level to work in, in single precision, between solves.
  float* room(std::size_t index) { return cycle_.levels[index].state.residual.data(); }
  // From here on the smoother adapts to nothing.
  void keep_smoother() { adapts_ = false; }

  // Whether the smoother may work on blocks from here on; if not, those that are there go.
  void allow_blocks(bool allowed);

  // Call after operators have changed on the levels up to `top`. `spectrum`: so much that the
  // largest eigenvalues have.
  void refresh(std::size_t top, bool spectrum);
  // After the operator of level `top` has changed as from one step of many to the next, and those
  // below with it where they are `fresh`: a factor of that level itself goes on as a preconditioner
  // as long as it serves.
  void refresh_lazily(std::size_t top, bool fresh);
  // How often a level has been factored.
  int factors() const { return factors_; }

  // Solves a level's system, to the limits given. `each` is called after every iteration. Throws where the run has been cancelled, and
  // FairingError(underdetermined) where a factor finds the level singular.
  LevelSolve solve(std::size_t index, const PcgLimits& limits, const LinearSystem& system,
                   const std::function<void(const PcgResult&)>& each);

  // Before a level's first solve: from how the last one went, how far both are to be solved, and what
  // a solve leaves that something is corrected after.
  void choose_degree(const LevelSolve& last, double tolerance, double next_tolerance,
                     double solve_gain);

 private:
  // Of a level's solves: iterations, and what they have gained, as a logarithm. A solve from its own
  // start is judged by the error as well: where loads have changed, what is left of the residual
  // says little.
  struct Convergence {
    int iterations = 0;
    double gained = 0;
    Convergence after(const PcgResult& result, bool from_start) const;
  };

  void refactor();
  PcgResult iterate(std::size_t index, const PcgLimits& limits, const LinearSystem& system,
                    const std::function<void(const PcgResult&)>& each, LevelSolve& out);
  bool solve_by_old_factor(const PcgLimits& limits, const LinearSystem& system, LevelSolve& out);
  void solve_direct(CoarseSolver& solver, const PcgLimits& limits, const LinearSystem& system,
                    LevelSolve& out);
  void estimate_eigenvalues(std::size_t top, const double* residual);

  // adaptation.cpp
  bool adapts(bool direct) const { return adapts_ && options_.smoother_degree == 0 && !direct; }
  // After each iteration: whether it is to go on as it is. Raises the degree.
  bool goes_on(std::size_t index, const PcgResult& so_far, const PcgLimits& limits);
  // After one that did not: whether it is to go on with another smoother.
  bool changes_smoother(std::size_t index);
  bool is_too_hard(std::size_t index) const;
  bool wants_blocks(std::size_t index, const Convergence& so_far) const;
  void take_blocks(std::size_t index);
  bool blocks_fail(std::size_t index) const;
  void leave_blocks();
  void promote_to_coarsest(std::size_t index);
  bool knows_factor_below(std::size_t index) const;
  bool may_factor(std::size_t index) const;
  bool fits_factor(std::size_t index) const;  // in memory too
  bool factors_cheaply(std::size_t index) const;
  void raise_degree(std::size_t index, const PcgResult& result, double tolerance);

  Workers& workers_;
  HierarchyOptions options_;
  bool adapts_ = true;
  bool blocks_allowed_ = true;
  bool is_bounded_ = false;  // the present solve may end early
  std::vector<std::size_t> unknowns_;
  std::vector<Convergence> convergence_;  // with the diagonal
  VCycle cycle_;
  std::unique_ptr<CoarseSolver> coarse_;
  bool is_factor_old_ = false;  // of another K than its level's
  int factors_ = 0;
  PcgState pcg_;
};

}  // namespace fairing
