// SPDX-License-Identifier: GPL-3.0-or-later
// The operators of all levels, and linear solves on any of them: conjugate gradients around
// V-cycles, with a direct solve where the cycle ends. It adapts: the smoother has lines where faces
// are thin, its degree rises if iterations gain little, and if options say so, a level that stays
// difficult is factored.
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "multigrid/pcg.h"
#include "multigrid/v_cycle.h"

namespace fairing {

// Levels of up to so many unknowns are factored rather than smoothed; the cycle ends on the finest
// of them.
constexpr std::size_t tiny_level = 1200;

// The smoother's first degree (measured: the fastest, by little, of 2, 3, 4 and 6, for a plate and
// for total curvature).
constexpr int usual_degree = 3;

// A hard level, if it is not too large, is smoothed; or factored once a trial shows that it is hard;
// or factored without a trial where it is small or lies above a hard one.
enum class HardLevels { smoothed, factored, expected };

struct HierarchyOptions {
  int smoother_degree = 0;     // 0: chosen by the solves, from the usual one on
  bool always_factor = false;  // the coarsest level is ill-conditioned, whatever its size
  HardLevels hard_levels = HardLevels::smoothed;
  // From this level on (coarsest: 0) the largest eigenvalue is that of the level below, whose edges
  // have eight pieces. (With four it still changes: the smoother then amplified vectors, and a rough
  // sphere took 14 iterations, with eight five.)
  std::size_t settled = 4;
};

struct HierarchyLevel {
  LevelOperator& op;
  LevelTransfer* to_coarser;  // null on the coarsest
  std::size_t unknowns;
};

// The result of a solve.
struct LevelSolve {
  int iterations = 0;
  double residual = 0, energy_error = 0;  // at the end, as in PcgResult
  double largest_eigenvalue = 0;          // as used by the smoother
  int smoother_degree = 0;                // at the end; 0: no smoother was used
  bool direct = false, converged = false;
  bool enough = false;            // as PcgLimits::enough says
  bool lines = false;             // whether the smoother has lines
  std::vector<double> residuals;  // after 0, 1, … iterations
};

class Hierarchy {
 public:
  // Levels: coarsest first. Their operators and transfers must outlive the hierarchy.
  Hierarchy(Workers& workers, const HierarchyOptions& options,
            const std::vector<HierarchyLevel>& levels);

  // A work vector of the level in single precision, for use between solves.
  float* room(std::size_t index) { return cycle_.levels[index].state.residual.data(); }
  // Stops the smoother's adaptation.
  void keep_smoother() { adapts_ = false; }

  // Number of factorizations of a level so far.
  int factors() const { return factors_; }

  // Solves a level's system to the given limits. Throws FairingError: cancelled; underdetermined if
  // a factorization finds the level singular.
  LevelSolve solve(std::size_t index, const PcgLimits& limits, const LinearSystem& system);

  // Before a level's first solve: chooses the degree from the last solve, the tolerances of both,
  // and the share that a solve leaves before a correction.
  void choose_degree(const LevelSolve& last, double tolerance, double next_tolerance,
                     double solve_gain);

 private:
  // Updates the cached data of the operators to their versions, except the factor.
  void update(std::size_t top);
  std::size_t unknowns(std::size_t index) const { return cycle_.levels[index].unknowns; }
  PcgResult iterate(std::size_t index, const PcgLimits& limits, const LinearSystem& system,
                    LevelSolve& out);
  void solve_direct(CoarseSolver& solver, const PcgLimits& limits, const LinearSystem& system,
                    LevelSolve& out);
  void seek_lines(std::size_t index);
  bool has_eigenvalue_of_below(std::size_t index) const;
  void estimate_eigenvalues(std::size_t top, const double* residual);

  // adaptation.cpp
  bool adapts(bool direct) const { return adapts_ && options_.smoother_degree == 0 && !direct; }
  // After each iteration: whether to continue unchanged. Raises the degree.
  bool continues(std::size_t index, const PcgResult& so_far, const PcgLimits& limits);
  bool may_factor(std::size_t index, const PcgLimits& limits) const;
  bool is_too_hard(std::size_t index, const PcgLimits& limits) const;
  bool is_above_hard(std::size_t index) const;
  void promote_to_coarsest(std::size_t index);
  void raise_degree(const PcgResult& result, const PcgLimits& limits);

  Workers& workers_;
  HierarchyOptions options_;
  bool adapts_ = true;
  VCycle cycle_;
  int factors_ = 0;
  int degree_of_two_ = 0;  // the smoother's, if two cycles precondition (LinearSystem::between)
  PcgState pcg_;
};

}  // namespace fairing
