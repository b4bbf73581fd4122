// SPDX-License-Identifier: GPL-3.0-or-later
// The constraints of control vertices, for either energy. A control vertex c is held by a force F
// towards its target, on its pad or, without a pad, at its point. There are three laws for F:
//
//   exactly              F is what keeps it there (no spring: it is not an unknown)
//   by a weight w        F = w |p - target|
//   within a tolerance   F = w |p - target|, with w the multiplier of |p - target| <= tolerance
//
// On a pad F is the whole load: total(c) f_c = F (pads.h). Positions and distances are in working
// coordinates.
#pragma once

#include <span>

#include "constraints/pads.h"
#include "stencil/weights.h"

namespace fairing {

// Unit of the caller's weights: 1 balances the bending of one control edge, whatever the mesh's
// size. First in the metric of `flat`; then in space, for energies of the surface itself.
double weight_unit(const ControlMesh& mesh, const std::vector<FlatFace>& flat);
double weight_unit(const ControlMesh& mesh);

// The relative duality gap at which the weights are accurate enough; the same below the finest
// level.
constexpr double gap_wanted = 1e-4, coarse_gap = 1e-3;

// Weight of a spring that is as good as fixed, in stiffnesses of the surface or in units of
// weights.
constexpr double stiff = 1e4;

// The common part of both kinds of motion: in space (ball_constraints.h) and along normals
// (interval_constraints.h). Those find the multipliers.
class ControlConstraints {
 public:
  // No constraint on control vertices that move.
  ControlConstraints(const ControlMesh& mesh, std::span<const Vec3> targets,
                     const Unknowns& unknowns)
      : mesh_(mesh), targets_(targets), unknowns_(unknowns) {}
  // `targets` of the control vertices, and `tolerances` of the input vertices and their copies, in
  // working coordinates; infinity: the caller's weight alone. `weights`: as many, in units of
  // `unit`, or empty; they are lower bounds. `mesh`, `targets` and `unknowns` must outlive the
  // constraints.
  ControlConstraints(const ControlMesh& mesh, std::span<const Vec3> targets,
                     const Unknowns& unknowns, std::span<const double> weights, double unit,
                     std::vector<double> tolerances);

  // One per control vertex. Empty: all are fixed or free.
  const VertexWeights& weights() const { return weights_; }
  bool any() const { return !weights_.empty(); }
  // First weights in space; vertices with a tolerance have stiff springs.
  VertexWeights start_weights() const;
  // Whether any vertex has a tolerance.
  bool active() const { return active_; }
  // Where control vertices belong.
  std::span<const Vec3> targets() const { return targets_; }
  // The number of input vertices and copies; whether one is an unknown with a tolerance.
  std::size_t size() const { return tolerance_.size(); }
  bool bound(std::size_t v) const { return unknowns_.vertex[v] && std::isfinite(tolerance_[v]); }

  // How far the energy may be above the minimum, relative.
  double gap() const { return gap_; }

  // Moves vertices outside their balls onto them.
  void enforce(double* x) const;
  // The unknowns without the vertices that are held.
  Unknowns without_held() const;

 protected:
  // The nearest point in the ball of a vertex.
  Vec3 in_ball(const Vec3& p, std::size_t v) const;
  // `farthest` of all distances, in tolerances.
  void set_gap(double gap, double energy, double farthest);

  const ControlMesh& mesh_;
  std::span<const Vec3> targets_;
  const Unknowns& unknowns_;
  double unit_ = 1;
  bool active_ = false;
  std::vector<double> tolerance_;  // to be met, one per input vertex and copy
  std::vector<double> base_;       // the caller's own weights
  VertexWeights weights_;
  double gap_ = 0, start_energy_ = 0;
};

}  // namespace fairing
