// SPDX-License-Identifier: GPL-3.0-or-later
// What joins the diagonal of K in the smoother where faces are thin: its band along lines of strongly
// coupled points. Thin faces are stiff in one direction, in which a diagonal gains next to nothing;
// lines run along it, and solve for it.
#pragma once

#include <vector>

#include "multigrid/level_operator.h"

namespace fairing {

// B: on a line K's numbers between points that are at most two apart, elsewhere its diagonal D.
// Vectors are those of the operator. Every line writes its own points only, so results are the same
// for any number of threads. All functions throw where the run has been cancelled.
class LineJacobi {
 public:
  // Seeks lines: there are none where nothing is coupled strongly, or the operator does not tell.
  // Then B is D. The operator must outlive the lines.
  LineJacobi(LevelOperator& op, Workers& workers);
  ~LineJacobi() { MemoryLedger::remove(bytes_); }
  LineJacobi(const LineJacobi&) = delete;
  LineJacobi& operator=(const LineJacobi&) = delete;

  // Call after the operator has changed. Lines keep their points; where the operator has nothing to
  // tell of them any more, B is D until it has.
  void refactor();
  bool any() const { return !bundle_.empty(); }
  bool serves() const { return serves_; }

  // What B gives beyond the diagonal: x, change += step (B^-1 - D^-1) r; `change` may be null.
  void add(float step, const float* r, float* x, float* change) const;

  // Lines of about one length, side by side: number i of lane l is at i * lanes + l.
  static constexpr std::size_t lanes = 8;
  struct Bundle {
    std::vector<Index> point;  // beyond a line's end, and where there is no line: any of its points
    // The inverse of a pivot and of D; L's numbers one and two before the pivot. Beyond the end zero.
    std::vector<float> inverse, diagonal, before, further;
  };

 private:
  void bundle_lines();
  void factor();
  void factor_line(std::size_t line, Bundle& bundle, std::size_t lane) const;

  LevelOperator& op_;
  Workers& workers_;
  LineBand band_;
  std::vector<std::size_t> order_;  // lines, longest first: `lanes` of them make a bundle
  std::vector<Bundle> bundle_;
  bool serves_ = false;
  std::size_t bytes_ = 0;
};

}  // namespace fairing
