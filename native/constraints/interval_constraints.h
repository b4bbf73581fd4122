// SPDX-License-Identifier: GPL-3.0-or-later
// Control vertices that move along their normals, under Gauss-Newton steps: each stays within an
// interval. The part of p - c across the normal stays and uses its share of the tolerance.
#pragma once

#include <utility>
#include <vector>

#include "constraints/control_constraints.h"

namespace fairing {

// Keeps control vertices within their intervals by semi-smooth Newton steps (primal-dual active
// sets): a vertex is on one end of its interval, held there by a stiff spring, or is left to the
// caller's weight. It moves to an end that it would pass, and leaves an end that would have to pull
// it back. (Ends are points here; on a ball, where a vertex slides, ball_constraints.h is better.)
class IntervalConstraints : public ControlConstraints {
 public:
  IntervalConstraints(ControlConstraints constraints)
      : ControlConstraints(std::move(constraints)) {}

  // Switches to a surface x that moves along `normal`; both have 3 numbers for each control vertex
  // at least. `ends`: earlier ends(); empty: those at which the surface is. `stiffness` of the
  // surface at each control vertex, against moving it alone.
  void linearize_about(const double* normal, const double* x, const std::vector<double>& ends,
                       std::vector<double> stiffness);
  const std::vector<double>& stiffness() const { return stiffness_; }
  // For each input vertex the end it is on, 1 or -1; 0: none.
  const std::vector<double>& ends() const { return ends_; }

  // Displacement of a control vertex along its normal to which its spring pulls.
  double target(std::size_t v) const {
    return (on_end(v) ? ends_[v] * reach_[v] : 0.0) - along_[v];
  }

  // In all of these `h` has the displacements of the control vertices, one number each, as solved
  // with the current weights.

  // Whether other ends could gain at most `wanted` of the energy, or no vertex may change its end:
  // one that has changed too often stays until linearize_about().
  bool settled(double energy, double wanted, const double* h);
  // If forces tell which ends are right, changes to those that h requires, and moves x to them.
  // Returns whether any changed.
  bool renew(const double* h, bool loads_settled, double* x);
  void put_on_ends(double* x) const;

 private:
  bool on_end(std::size_t v) const { return v < ends_.size() && ends_[v] != 0; }
  // The force with which the vertex presses against its end.
  double pressure(std::size_t v, double h) const {
    return ends_[v] * weights_[v] * (h - target(v)) - base_[v] * reach_[v];
  }
  double excess(std::size_t v, double h) const { return std::abs(along_[v] + h) - reach_[v]; }
  // The right end for a vertex.
  double end_for(std::size_t v, double h) const;
  void choose_weight(std::size_t v);

  std::vector<double> stiffness_;
  std::vector<double> along_;  // p - c along the normals, one per control vertex
  std::vector<double> reach_;  // half the interval, one per input vertex
  std::vector<double> ends_;
  std::vector<int> changes_;  // number of changed ends
};

}  // namespace fairing
