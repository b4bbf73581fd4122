// SPDX-License-Identifier: GPL-3.0-or-later
// What holds the control vertices, for either energy. A control vertex c is held by a force F towards
// its target, on its pad or, where it has none, at its point. Three laws for the same F:
//
//   exactly              F is what keeps it there (no spring: it is no unknown)
//   by a weight w        F = w |p - target|
//   within a tolerance   F = w |p - target|, with w the multiplier of |p - target| <= tolerance
//
// On a pad the whole of the load stands for F: total(c) f_c = F (pads.h). Positions and distances
// are in working coordinates.
#pragma once

#include <span>

#include "constraints/pads.h"
#include "stencil/weights.h"

namespace fairing {

// Unit of the caller's weights: 1 balances the bending of one control edge, whatever the mesh's
// size. In the metric of `flat`; then in space, for energies of the surface itself.
double weight_unit(const ControlMesh& mesh, const std::vector<FlatFace>& flat);
double weight_unit(const ControlMesh& mesh);

// The duality gap, relative to the energy, at which the weights are good enough; and below the
// finest level.
constexpr double gap_wanted = 1e-4, coarse_gap = 1e-3;

// Of a spring that is as good as fixed, in stiffnesses of the surface or in units of weights.
constexpr double stiff = 1e4;

// What both kinds of motion share: in space (ball_constraints.h) and along normals
// (interval_constraints.h). These find the multipliers.
class ControlConstraints {
 public:
  // Nothing holds a control vertex that moves.
  ControlConstraints(const ControlMesh& mesh, std::span<const Vec3> targets,
                     const Unknowns& unknowns)
      : mesh_(mesh), targets_(targets), unknowns_(unknowns) {}
  // `targets` of the control vertices, and `tolerances` of the input vertices and their copies, in
  // working coordinates; infinity: the caller's weight alone, nothing to find. `weights`: as many, in
  // units of `unit`; or empty. They are lower bounds. `mesh`, `targets` and `unknowns`
  // must outlive the constraints.
  ControlConstraints(const ControlMesh& mesh, std::span<const Vec3> targets,
                     const Unknowns& unknowns, std::span<const double> weights, double unit,
                     std::vector<double> tolerances);

  // One a control vertex. Empty: all stay, or are free.
  const VertexWeights& weights() const { return weights_; }
  bool any() const { return !weights_.empty(); }
  // To begin with in space: within tolerances so large that they hardly give way.
  VertexWeights start_weights() const;
  // Whether there is anything to find.
  bool active() const { return active_; }
  // Where control vertices belong.
  std::span<const Vec3> targets() const { return targets_; }
  // Of input vertices and copies: how many, and whether one is an unknown that may move only so far.
  std::size_t size() const { return tolerance_.size(); }
  bool bound(std::size_t v) const { return unknowns_.vertex[v] && std::isfinite(tolerance_[v]); }

  // How far the energy may still be over the least possible one, relative.
  double gap() const { return gap_; }

  // Puts those on the ball that are outside.
  void enforce(double* x) const;
  // The unknowns without the vertices that are held.
  Unknowns without_held() const;

 protected:
  // `farthest` of all distances, in tolerances.
  void set_gap(double gap, double energy, double farthest);

  const ControlMesh& mesh_;
  std::span<const Vec3> targets_;
  const Unknowns& unknowns_;
  double unit_ = 1;
  bool active_ = false;
  std::vector<double> tolerance_;  // aimed at, one an input vertex and copy
  std::vector<double> base_;       // the caller's own weights
  VertexWeights weights_;
  double gap_ = 0, start_energy_ = 0;
};

}  // namespace fairing
