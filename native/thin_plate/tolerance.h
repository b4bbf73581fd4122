// SPDX-License-Identifier: GPL-3.0-or-later
// Control vertices that may move: within a tolerance, against weights, or by the paper's epsilon
// afterwards. Positions and distances are in working coordinates. What solves throws as
// ThinPlateSolver does.
#pragma once

#include <cmath>

#include "thin_plate/solver.h"

namespace fairing {

// Unit of the caller's weights: 1 balances the bending of one control edge, whatever the mesh's
// size.
double weight_unit(const ControlMesh& mesh, const std::vector<FlatFace>& flat);

// The duality gap, relative to the energy, at which the weights are good enough.
constexpr double gap_wanted = 1e-4;

// Keeps weighted control vertices within their tolerances of their targets, with the energy as low
// as that allows. The weights are the multipliers of |p - c|^2 <= tolerance^2: a vertex is held with
// the force w |p - c|, and the multipliers are found by steps of the augmented Lagrangian,
//
//   w <- max(0, (w + s) |p - c| / tolerance - s),
//
// with s about as stiff as what the surface and the neighbours' weights set against the vertex: the
// force changes by s times the way to the ball, and vanishes where the vertex stands within it.
class ToleranceConstraint {
 public:
  // Nothing holds a control vertex that moves.
  ToleranceConstraint(const ControlMesh& mesh, std::span<const Vec3> targets,
                      const Unknowns& unknowns)
      : mesh_(mesh), targets_(targets), unknowns_(unknowns) {}
  // `targets` of the control vertices, and `tolerances` of the input vertices, in working
  // coordinates; infinity: the caller's weight alone, nothing to find. `weights`: one an input
  // vertex, in units of `unit`; or empty. They are lower bounds. `mesh`, `targets` and `unknowns`
  // must outlive the constraint.
  ToleranceConstraint(const ControlMesh& mesh, std::span<const Vec3> targets,
                      const Unknowns& unknowns, std::span<const double> weights, double unit,
                      std::vector<double> tolerances);

  // One a control vertex. At first so large that they hardly give way.
  const VertexWeights& weights() const { return weights_; }
  // Whether there is anything to find.
  bool active() const { return active_; }
  // What the weights draw control vertices to.
  std::span<const Vec3> targets() const { return aims_.empty() ? targets_ : aims_; }
  // Of input vertices: how many, and whether one is an unknown that may move only so far.
  std::size_t size() const { return tolerance_.size(); }
  bool bound(std::size_t v) const { return unknowns_.vertex[v] && std::isfinite(tolerance_[v]); }
  double tolerance(std::size_t v) const { return tolerance_[v]; }

  // Of the surface at each control vertex, against moving it alone. Call before what follows; it
  // must outlive the constraint.
  void set_stiffness(std::span<const double> of_surface) { of_surface_ = of_surface; }
  // A new level, on which nothing is pinned.
  void start_level();
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

  // For the last solve: vertices that the multipliers have left outside by their last digits are
  // held on the ball.
  void pin(const double* x);
  // Puts those on the ball that are outside still, and measures the gap of this surface.
  void finish(double energy, double* x);

  // How far the energy may still be over the least possible one, relative.
  double gap() const { return gap_; }

 private:
  double distance(const double* x, std::size_t v) const;
  Vec3 nearest_allowed(const double* x, std::size_t v) const;
  void choose_stiffness();
  // `farthest` of all distances, in tolerances.
  void take_gap(double gap, double energy, double farthest);

  const ControlMesh& mesh_;
  std::span<const Vec3> targets_;
  const Unknowns& unknowns_;
  double unit_ = 1;
  bool active_ = false, begun_ = false, far_ = true;
  std::vector<double> tolerance_;  // aimed at, one an input vertex
  std::vector<double> base_;       // the caller's own weights
  std::span<const double> of_surface_;
  std::vector<double> stiffness_;   // s of the steps
  std::vector<double> around_;      // the mean weight of a vertex and its neighbours
  std::vector<double> multiplier_;  // below zero where the vertex stands well within its ball
  VertexWeights weights_, unpinned_;
  std::vector<Vec3> aims_;  // empty: the targets
  double gap_ = 0, start_energy_ = 0;
};

// The epsilon post-process of [Kobbelt 1997a, §5]: interpolated control vertices step to where the
// energy wants them, at most epsilon (working units) away, and the surface follows; this takes the
// cusps off. Where sheets touch, they stay. Returns the solves taken.
int release_control_vertices(ThinPlateSolver& system, const ControlMesh& mesh,
                             std::span<const Vec3> given, double epsilon, Array<double>& x);

}  // namespace fairing
