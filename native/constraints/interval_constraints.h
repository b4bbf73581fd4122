// SPDX-License-Identifier: GPL-3.0-or-later
// Control vertices that move along their normals, as Gauss-Newton steps take them: each stays within
// an interval. What lies across the normal, p - c less its part along it, stays as it is and takes
// its share of the tolerance.
#pragma once

#include <utility>
#include <vector>

#include "constraints/control_constraints.h"

namespace fairing {

// Keeps control vertices within their intervals by semi-smooth Newton steps (primal-dual active
// sets): a vertex stands on one end of its interval, held there by a spring that hardly gives way,
// or is left to the caller's weight. It goes to the end that it would pass, and leaves one that it
// would have to be drawn to. (The ends are points here; on a ball's surface, where a vertex slides,
// ball_constraints.h serves better.)
class IntervalConstraints : public ControlConstraints {
 public:
  IntervalConstraints(ControlConstraints constraints)
      : ControlConstraints(std::move(constraints)) {}

  // From here on it is about a surface x that moves along `normal`: of the control vertices at the
  // least, 3 numbers each. `ends`: as ends() were; empty: those where the surface stands.
  // `stiffness` of the surface at each control vertex, against moving it alone.
  void linearize_about(const double* normal, const double* x, const std::vector<double>& ends,
                       std::vector<double> stiffness);
  const std::vector<double>& stiffness() const { return stiffness_; }
  // Of each input vertex: the end it stands on, 1 or -1; 0: on none.
  const std::vector<double>& ends() const { return ends_; }

  // How far its spring would like to take a control vertex along its normal.
  double target(std::size_t v) const {
    return (on_end(v) ? ends_[v] * reach_[v] : 0.0) - along_[v];
  }

  // Control vertices are displaced by `h`, one number each, that was solved for with these weights.

  // Whether what other ends could gain is at most `wanted` of the energy, or no vertex may take
  // another end: one that has done so too often stays until linearize_about().
  bool settled(double energy, double wanted, const double* h);
  // Where forces tell which ends are right, the ends that h asks for, to which x goes. Returns whether
  // there are such.
  bool renew(const double* h, bool loads_settled, double* x);
  void put_on_ends(double* x) const;

 private:
  bool on_end(std::size_t v) const { return v < ends_.size() && ends_[v] != 0; }
  // By which force the vertex presses against its end.
  double pressure(std::size_t v, double h) const {
    return ends_[v] * weights_[v] * (h - target(v)) - base_[v] * reach_[v];
  }
  double excess(std::size_t v, double h) const { return std::abs(along_[v] + h) - reach_[v]; }
  // The end that a vertex should stand on.
  double end_for(std::size_t v, double h) const;
  void choose_weight(std::size_t v);

  std::vector<double> stiffness_;
  std::vector<double> along_;  // p - c along the normals, one a control vertex
  std::vector<double> reach_;  // half the interval, one an input vertex
  std::vector<double> ends_;
  std::vector<int> changes_;  // of ends
};

}  // namespace fairing
