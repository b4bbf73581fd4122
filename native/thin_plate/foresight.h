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

  struct Seen {
    Loads rest;  // H^T r; of vertices on springs what these do not give way to
    Loads forces;
    double residual = 0;
  };
  // Of a solve that starts with the residual r: the forces left at vertices on pads. Empty where it has
  // nothing to show.
  Seen before(const double* r, bool direct, const Loads& forces) const {
    return is_judged_ ? Seen{} : look(r, direct, forces);
  }
  // After it, with x and its residual: the forces become what they would be after a whole solve.
  // `direct`: it is whole.
  void foresee(const Seen& before, const double* x, const double* r, bool direct, const Hats* hats,
               Loads& forces);

  // Where a whole solve would have the control vertices, 3 numbers each.
  const double* vertices() const { return vertices_.data(); }

 private:
  Seen look(const double* r, bool direct, const Loads& forces) const;
  void judge(const Seen& before, const Seen& after);
  double spring(std::size_t v) const;

  ThinPlateLevels& levels_;
  int level_;
  const std::vector<double>& stiffness_;
  std::vector<double> vertices_;
  // What the first solve has shown: whether forces that are foreseen change less than those read from
  // the vertices' own rows do.
  bool is_believed_ = true, is_judged_ = false;
};

}  // namespace fairing
