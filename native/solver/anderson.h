// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <deque>

#include "execution/workers.h"
#include "solver/level_operator.h"

namespace fairing {

// Anderson's acceleration of a sequence of Newton-like steps [Anderson 1965; Walker and Ni 2011]: where each step leaves a
// fixed share of the error, the last few steps tell which. Measured in the norm of the operator.
class Anderson {
 public:
  void reset();

  // step <- the accelerated step, from this one and the last few.
  void mix(LevelOperator& op, Workers& workers, Array<double>& step);
  // What of the mixed step was gone.
  void took(double length);

 private:
  struct Pair {
    Array<double> change, gone;  // of the steps from one time to the next; of the surface in between
  };
  std::deque<Pair> pairs_;
  Array<double> last_, gone_;
};

}  // namespace fairing
