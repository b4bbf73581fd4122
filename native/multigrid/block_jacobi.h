// SPDX-License-Identifier: GPL-3.0-or-later
// What stands for the diagonal of K in the smoother where faces are thin: its blocks of strongly
// coupled points, each with a factor. Thin faces are stiff in one direction, in which a diagonal
// gains next to nothing; blocks lie along it, and solve for it.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "multigrid/level_operator.h"
#include "multigrid/strong_blocks.h"

namespace fairing {

// B = L L^T, block by block. Vectors are those of the operator; points that are no unknowns are left
// alone. Every block writes its own points only, so results are the same for any number of threads.
// All functions throw where the run has been cancelled.
class BlockJacobi {
 public:
  // Null where the operator has no rows to give. The operator must outlive the blocks.
  static std::unique_ptr<BlockJacobi> make(const LevelOperator& op, Workers& workers);
  ~BlockJacobi() { MemoryLedger::remove(bytes_); }
  BlockJacobi(const BlockJacobi&) = delete;
  BlockJacobi& operator=(const BlockJacobi&) = delete;

  // Call after the operator has changed. Each block keeps its points. False: the operator has no rows
  // any more, and the blocks are of no use.
  bool refactor();

  // x <- L^-1 x, and x <- L^-T x
  void forward(float* x) const;
  void backward(float* x) const;

  // x = d = step B^-1 r
  void start_from_zero(float step, const float* r, float* x, float* d) const;
  // A smoothing step with B for D; step.next holds K d and takes the new change.
  void finish_step(const SmoothingStep& step) const;

 private:
  // L by columns, points in the order of elimination.
  struct Factor {
    std::vector<Index> point;
    std::vector<float> inverse;      // of the diagonal
    std::vector<std::uint32_t> end;  // of each column's entries below the diagonal
    std::vector<std::uint16_t> row;
    std::vector<float> number;

    std::size_t bytes() const;
    template <int C>
    void forward(float* x) const;
    template <int C>
    void backward(float* x) const;
  };
  class Factorizer;

  BlockJacobi(const LevelOperator& op, Workers& workers) : op_(op), workers_(workers) {}
  void factor(const SymmetricRows& rows);
  template <int C, class Load, class Solve, class Store>
  void visit(const Load& load, const Solve& solve, const Store& store) const;
  template <class Solve>
  void replace(float* x, const Solve& solve) const;

  const LevelOperator& op_;
  Workers& workers_;
  StrongBlocks blocks_;
  std::vector<Factor> factors_;
  std::size_t bytes_ = 0;
};

}  // namespace fairing
