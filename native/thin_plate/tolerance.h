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

// Keeps weighted control vertices within their tolerances of their targets, with the energy as low as
// that allows. The weights are the multipliers of |p - c|^2 <= tolerance^2, found by a fixed point:
// a vertex held with force w |p - c| needs the weight w |p - c| / tolerance.
class ToleranceConstraint {
 public:
  // Nothing holds a control vertex that moves.
  ToleranceConstraint(const ControlMesh& mesh, std::span<const Vec3> targets,
                      const Unknowns& unknowns)
      : mesh_(mesh), targets_(targets), unknowns_(unknowns) {}
  // `targets` of the control vertices, and `tolerances` of the input vertices, in working
  // coordinates; infinity: the caller's weight alone, nothing to find. `weights`: one an input
  // vertex, in units of `unit`; or empty. `mesh`, `targets` and `unknowns` must outlive the
  // constraint.
  ToleranceConstraint(const ControlMesh& mesh, std::span<const Vec3> targets,
                      const Unknowns& unknowns, std::span<const double> weights, double unit,
                      std::vector<double> tolerances);

  VertexWeights start_weights() const { return weights_; }
  bool active() const { return active_; }

  // Adapts the weights on one level until the constraint holds and the duality gap is closed; x
  // follows.
  void settle(ThinPlateSolver& system, int level, Array<double>& x);

  // The last solve on the finest level: vertices that the fixed point has left outside by their
  // last digits are held on the ball. No control vertex is outside afterwards.
  LevelReport finish(ThinPlateSolver& system, double relative_residual, Array<double>& x);

  int rounds() const { return rounds_; }
  // How far the energy may still be over the least possible one, relative.
  double gap() const { return gap_; }

 private:
  // Whether it is an unknown that may move only so far.
  bool bound(std::size_t v) const { return unknowns_.vertex[v] && std::isfinite(tolerance_[v]); }
  double distance(const Array<double>& x, std::size_t v) const;
  Vec3 nearest_allowed(const Array<double>& x, std::size_t v) const;
  bool settled(double energy, const Array<double>& x);
  void adapt(const Array<double>& x);

  const ControlMesh& mesh_;
  std::span<const Vec3> targets_;
  const Unknowns& unknowns_;
  double unit_ = 1;
  bool active_ = false;
  std::vector<double> tolerance_;  // aimed at, one an input vertex
  std::vector<double> base_;       // the caller's own weights
  VertexWeights weights_;
  std::vector<double> power_;  // of the fixed point's step, per vertex
  std::vector<std::uint8_t> was_outside_;
  int rounds_ = 0;
  double gap_ = 0, start_energy_ = 0;
};

// The epsilon post-process of [Kobbelt 1997a, §5]: interpolated control vertices step to where the
// energy wants them, at most epsilon (working units) away, and the surface follows; this takes the
// cusps off. Returns the solves taken.
int release_control_vertices(ThinPlateSolver& system, const ControlMesh& mesh,
                             std::span<const Vec3> given, double epsilon, Array<double>& x);

}  // namespace fairing
