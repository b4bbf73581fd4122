// SPDX-License-Identifier: GPL-3.0-or-later
// Control vertices that move in space, as the thin plate's do: each stays within a ball.
#pragma once

#include "hold/control_hold.h"

namespace fairing {

// Keeps weighted control vertices within their tolerances of their targets, with the energy as low
// as that allows. The multipliers are found by steps of the augmented Lagrangian,
//
//   w <- max(0, (w + s) |p - c| / tolerance - s),
//
// with s about as stiff as what the surface and the neighbours' weights set against the vertex: the
// force changes by s times the way to the ball, and vanishes where the vertex stands within it.
class HoldInSpace : public ControlHold {
 public:
  using ControlHold::ControlHold;
  // At first weights are so large that they hardly give way.
  HoldInSpace(const ControlMesh& mesh, std::span<const Vec3> targets, const Unknowns& unknowns,
              std::span<const double> weights, double unit, std::vector<double> tolerances);

  // What the weights draw control vertices to.
  std::span<const Vec3> aims() const { return aims_.empty() ? targets_ : aims_; }

  // The first weights, from the forces that hold this surface; false where there are weights
  // already.
  bool begin(const double* x);
  // Whether the duality gap of this surface and the weights it was solved with is `wanted`.
  bool settled(double energy, double wanted, const double* x);
  // Whether vertices were so far outside then that steps are guesses.
  bool far() const { return far_; }
  // What to add to the multipliers, one an input vertex, as this surface says.
  std::vector<double> correction(const double* x);
  // Adds so much to them, within bounds; `by` becomes what has been added.
  void change(std::vector<double>& by);

  // Whether tolerances are so small that nearly all vertices stand on their balls, and hardly move
  // there. Then each is *placed*, which holds it as if it were fixed, until leave_places() goes back
  // to the weights before.
  bool is_stiff() const;
  void place(const double* x);
  bool placed(std::size_t v) const { return is_placed_ && v < size() && bound(v); }
  // x <- placed vertices where they are to be.
  void put_placed(double* x) const;
  // Of placed vertices: by which forces each is held. Call before turn() and finish().
  void take_pulls(const std::vector<Vec3>& forces);
  // Whether the gap is as `wanted`; otherwise they are placed where their pulls say.
  bool turn(double energy, double wanted);
  void leave_places();

  // For the last solve: vertices that the multipliers have left outside by their last digits are
  // held on the ball.
  void pin(const double* x);
  // Puts those on the ball that are outside still, and measures the gap of this surface.
  void finish(double energy, double* x);

  // Of each input vertex: what makes changes of its multiplier comparable with changes of its load,
  // tolerance^2 over the hat's total; a vertex without a pad has the mean of the others. Empty where
  // there is nothing to find. `pads` may be null.
  std::vector<double> comparable(const Pads* pads) const;

 private:
  double distance(const double* x, std::size_t v) const;
  Vec3 on_ball(const Vec3& p, std::size_t v) const;
  void choose_stiffness();

  bool far_ = true;
  std::vector<double> stiffness_;   // s of the steps
  std::vector<double> around_;      // the mean weight of a vertex and its neighbours
  std::vector<double> multiplier_;  // below zero where the vertex stands well within its ball
  std::vector<Vec3> aims_;          // empty: the targets
  bool is_placed_ = false;
  std::vector<Vec3> pulls_;  // of placed vertices, without the caller's weights
};

}  // namespace fairing
