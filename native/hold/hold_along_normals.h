// SPDX-License-Identifier: GPL-3.0-or-later
// Control vertices that move along their normals, as Gauss-Newton steps take them: each stays within
// an interval. What lies across the normal, p - c less its part along it, stays as it is and takes
// its share of the tolerance.
#pragma once

#include <utility>
#include <vector>

#include "hold/control_hold.h"

namespace fairing {

// Keeps control vertices within their intervals by semi-smooth Newton steps (primal-dual active
// sets): a vertex stands on one end of its interval, held there by a spring that hardly gives way,
// or is left to the caller's weight. It goes to the end that it would pass, and leaves one that it
// would have to be drawn to. (The ends are points here; on a ball's surface, where a vertex slides,
// hold_in_space.h serves better.)
class HoldAlongNormals : public ControlHold {
 public:
  HoldAlongNormals(ControlHold hold) : ControlHold(std::move(hold)) {}

  // From here on it is about a surface x that moves along `normal`: of the control vertices at the
  // least, 3 numbers each. `sides`: as sides() were; empty: those where the surface stands.
  // `stiffness` of the surface at each control vertex, against moving it alone.
  void look_along(const double* normal, const double* x, const std::vector<double>& sides,
                  std::vector<double> stiffness);
  const std::vector<double>& stiffness() const { return stiffness_; }
  // Of each input vertex: the end it stands on, 1 or -1; 0: on none.
  const std::vector<double>& sides() const { return sides_; }
  bool on_end(std::size_t v) const { return v < sides_.size() && sides_[v] != 0; }

  // How far its spring would like to take a control vertex along its normal.
  double way(std::size_t v) const { return aim(v) - along_[v]; }

  // Of the displacement h, one number a control vertex at the least, that was solved for with these
  // weights: whether what other ends could gain is at most `wanted` of the energy.
  bool settled(double energy, double wanted, const double* h);
  // New ends, as h says; false: none. A vertex that has turned too often stays on its end until
  // look_along().
  bool turn(const double* h);

 private:
  double aim(std::size_t v) const { return v < sides_.size() ? sides_[v] * reach_[v] : 0.0; }
  // By which force the vertex presses against its end.
  double pressure(std::size_t v, double h) const {
    return sides_[v] * weights_[v] * (h - way(v)) - base_[v] * reach_[v];
  }
  double excess(std::size_t v, double h) const { return std::abs(along_[v] + h) - reach_[v]; }
  void choose_weight(std::size_t v);

  std::vector<double> stiffness_;
  std::vector<double> along_;  // p - c along the normals, one a control vertex
  std::vector<double> reach_;  // half the interval, one an input vertex
  std::vector<double> sides_;
  std::vector<int> turns_;
};

}  // namespace fairing
