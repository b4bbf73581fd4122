// SPDX-License-Identifier: GPL-3.0-or-later
// What a solve has left, foreseen: its residual r rests on the control vertices as H^T r, with H the
// cardinal surfaces of K (1 at one control vertex, 0 at the others). In their place stands the
// prolongation from the control vertices. So forces are known while the residual is still large, and
// solves between corrections may be short.
#pragma once

#include "thin_plate/levels.h"

namespace fairing {

// On one level.
class Foresight {
 public:
  // `stiffness` of the surface at each control vertex; empty where none moves. Both must outlive it.
  Foresight(ThinPlateLevels& levels, int level, const std::vector<double>& stiffness)
      : levels_(levels), level_(level), stiffness_(stiffness) {}

  // Around a solve to x, of residual r: the forces left at vertices on pads, which become what they
  // would be after a whole solve. `direct`: the solve is whole.
  void begin(const double* r, bool direct, const Loads& forces);
  void end(const double* x, const double* r, bool direct, const Hats* hats, Loads& forces);

  // Where a whole solve would have the control vertices, 3 numbers each.
  const double* vertices() const { return vertices_.data(); }

 private:
  struct Seen {
    Loads rest;  // H^T r; of vertices on springs what these do not give way to
    Loads forces;
    double residual = 0;
  };
  Seen look(const double* r, bool direct, const Loads& forces);
  void judge(const Seen& after);
  double spring(std::size_t v) const;

  ThinPlateLevels& levels_;
  int level_;
  const std::vector<double>& stiffness_;
  Seen before_;
  std::vector<double> vertices_;
  // What the first solve has shown: whether forces that are foreseen change less than those read from
  // the vertices' own rows do.
  bool is_believed_ = true, is_judged_ = false;
};

}  // namespace fairing
