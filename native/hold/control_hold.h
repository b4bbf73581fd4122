// SPDX-License-Identifier: GPL-3.0-or-later
// What holds the control vertices, for either energy. A vertex c is held by a force F towards its
// target, on its pad or, where it has none, at its point. Three laws for the same F:
//
//   exactly              F is what keeps it there (no spring: it is no unknown)
//   by a weight w        F = w |p - target|
//   within a tolerance   F = w |p - target|, with w the multiplier of |p - target| <= tolerance
//
// On a pad the whole of the load stands for F: total(c) f_c = F (pads.h). Positions and distances
// are in working coordinates.
#pragma once

#include <span>

#include "hold/pads.h"
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

// What both kinds of motion share: in space (hold_in_space.h) and along normals
// (hold_along_normals.h). There the multipliers are found.
class ControlHold {
 public:
  // Nothing holds a control vertex that moves.
  ControlHold(const ControlMesh& mesh, std::span<const Vec3> targets, const Unknowns& unknowns)
      : mesh_(mesh), targets_(targets), unknowns_(unknowns) {}
  // `targets` of the control vertices, and `tolerances` of the input vertices and their copies, in
  // working coordinates; infinity: the caller's weight alone, nothing to find. `weights`: as many, in
  // units of `unit`; or empty. They are lower bounds. `mesh`, `targets` and `unknowns`
  // must outlive the hold.
  ControlHold(const ControlMesh& mesh, std::span<const Vec3> targets, const Unknowns& unknowns,
              std::span<const double> weights, double unit, std::vector<double> tolerances);

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
  void take_gap(double gap, double energy, double farthest);

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

// How much each spring gives way before its load, s / w, with `stiffness` s of the surface. Empty
// where that is empty.
std::vector<double> compliance_ratios(const Unknowns& unknowns, const VertexWeights& weights,
                                      std::span<const double> stiffness, const Hats& hats);

// What holds control vertices at their points, into the rows of r: of a fixed one the force that its
// row asks for, of another one its spring's w away(v), less what its pad has taken over of it. On
// pads it becomes forces[v], which the loads are to take. r has none of a fixed vertex, be it fixed
// since the pads were made. `hats` may be null: r has the springs' forces.
template <int N, class Away>
void take_point_forces(const Unknowns& unknowns, const VertexWeights& weights, const Hats* hats,
                       const LoadsOf<N>& loads, Away&& away, LoadsOf<N>& forces, double* r) {
  using Force = Eigen::Matrix<double, N, 1>;
  const std::size_t count = hats ? forces.size() : weights.size();
  for (std::size_t v = 0; v < count; ++v) {
    Eigen::Map<Force> row(r + N * v);
    const bool on_pad = hats && hats->under(v);
    if (unknowns.vertex[v]) {
      if (weights.empty()) continue;
      Force pull = weights[v] * away(v);
      if (on_pad) forces[v] = pull -= hats->total(v) * loads[v];
      row += pull;
    } else {
      if (on_pad) forces[v] = -row;
      row.setZero();
    }
  }
}

}  // namespace fairing
