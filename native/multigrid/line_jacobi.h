// SPDX-License-Identifier: GPL-3.0-or-later
// Extends the diagonal of K in the smoother where faces are thin: by its band along lines of
// strongly coupled points. Thin faces are stiff in one direction, in which a diagonal gains next to
// nothing; lines run along it and are solved directly.
#pragma once

#include <vector>

#include "multigrid/level_operator.h"

namespace fairing {

// B: on a line K's numbers between points that are at most two apart, elsewhere its diagonal D.
// Vectors are those of the operator. Every line writes its own points only, so results do not
// depend on the number of threads. All functions throw FairingError(cancelled).
class LineJacobi {
 public:
  // Seeks lines; without strong couplings or offers there are none, and B is D. The operator must
  // outlive the lines.
  LineJacobi(LevelOperator& op, Workers& workers);
  ~LineJacobi() { MemoryLedger::remove(bytes_); }
  LineJacobi(const LineJacobi&) = delete;
  LineJacobi& operator=(const LineJacobi&) = delete;

  // Call after the operator has changed. Lines keep their points; while the operator writes no
  // numbers, B is D.
  void refactor();
  bool any() const { return !bundle_.empty(); }
  bool serves() const { return serves_; }

  // Adds the difference of B to the diagonal: x, change += step (B^-1 - D^-1) r; `change` may be
  // null.
  void add(float step, const float* r, float* x, float* change) const;

  // Lines of similar length, side by side: number i of lane l is at i * lanes + l.
  static constexpr std::size_t lanes = 8;
  struct Bundle {
    std::vector<Index> point;  // beyond a line's end, and without a line: any of its points
    // The inverse of a pivot and of D; L's numbers one and two before the pivot. Zero beyond the
    // end.
    std::vector<float> inverse, diagonal, before, further;
  };

 private:
  void bundle_lines();
  void factor();
  void factor_line(std::size_t line, Bundle& bundle, std::size_t lane) const;

  LevelOperator& op_;
  Workers& workers_;
  LineBand band_;
  std::vector<std::size_t> order_;  // lines, longest first, in bundles of `lanes`
  std::vector<Bundle> bundle_;
  bool serves_ = false;
  std::size_t bytes_ = 0;
};

}  // namespace fairing
