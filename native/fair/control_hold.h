// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "energy/thin_plate.h"
#include "fair/options.h"

namespace fairing {

// What holds the control vertices that are unknowns of the Gauss-Newton steps: the caller's weights, or weights that keep
// them within the tolerance, found step by step as in ToleranceConstraint.
class ControlHold {
 public:
  // `places` and tolerance in working coordinates.
  ControlHold(const ControlMesh& mesh, std::span<const Vec3> places, const Unknowns& unknowns,
              const FairOptions& options, double tolerance);

  std::span<const Vec3> places() const { return places_; }
  const VertexWeights& weights() const { return weights_; }
  bool any() const { return !weights_.empty(); }
  bool adapts() const { return tolerance_ > 0; }

  // New weights after a step.
  void adapt(const Array<double>& x);
  // Whether all are within the tolerance, or nearly so.
  bool holds(const Array<double>& x) const;
  // Puts those that are outside on the ball.
  void enforce(Array<double>& x) const;

  // The unknowns without the vertices that are held.
  Unknowns without_held() const;

 private:
  Vec3 away(const Array<double>& x, std::size_t v) const;

  std::span<const Vec3> places_;
  const Unknowns& unknowns_;
  double tolerance_ = 0;
  VertexWeights base_, weights_;
};

// What the caller's weights mean to a curvature energy: 1 balances the bending of one control edge.
double curvature_weight_unit(const ControlMesh& mesh);

}  // namespace fairing
