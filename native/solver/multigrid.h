// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>
#include <vector>

#include "solver/coarse.h"

namespace fairing {

// One level as the cycle sees it.
struct CycleLevel {
  LevelOperator* op = nullptr;
  LevelTransfer* transfer = nullptr;  // to the next coarser level; null on the coarsest
  double largest_eigenvalue = 0;
  SmootherState state;
};

// The V-cycle as a preconditioner, in single precision: one linear, symmetric positive definite map.
class VCycle {
 public:
  explicit VCycle(Workers& workers) : workers_(workers) {}

  std::vector<CycleLevel> levels;  // coarsest first
  CoarseSolver* coarse = nullptr;  // of levels[base]
  std::size_t base = 0;
  int degree = 6;  // of the smoother, before and after

  // levels[top].state.x <- M^-1 levels[top].state.residual; the residual is overwritten.
  void run(std::size_t top);

 private:
  Workers& workers_;
};

}  // namespace fairing
