// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <deque>

#include "multigrid/level_operator.h"
#include "parallel/workers.h"

namespace fairing {

// Anderson's acceleration of Newton-like steps [Anderson 1965; Walker and Ni 2011], of depth three:
// where each step leaves a fixed share of the error, the last few tell which. With the changes dF_k
// of the steps and dx_k of the iterate, accelerate() turns the step f into
//
//   f - sum_k c_k (dF_k + dx_k),
//
// with c the least squares of f - sum_k c_k dF_k in the operator's norm.
class Anderson {
 public:
  // Forgets all steps: what comes next is of another problem.
  void reset();

  // step <- the accelerated step; `op` is linearized where the step begins. Throws what op.apply()
  // throws.
  void accelerate(LevelOperator& op, Workers& workers, Array<double>& step);
  // The iterate has moved by `length` times the accelerated step.
  void accept(double length);

 private:
  struct Pair {
    Array<double> step_change, movement;  // dF and dx
  };
  std::deque<Pair> pairs_;
  Array<double> last_step_, last_movement_;  // as found, before it was accelerated; as taken
};

}  // namespace fairing
