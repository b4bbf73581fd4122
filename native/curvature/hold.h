// SPDX-License-Identifier: GPL-3.0-or-later
// Control vertices that are unknowns of the Gauss-Newton steps: what holds them while the steps are
// taken, and what follows the finest level's steps: those held within a tolerance are fixed there,
// interpolated ones are let go by epsilon.
#pragma once

#include <span>

#include "curvature/options.h"
#include "grid/accumulate.h"
#include "mesh/control_mesh.h"
#include "parallel/memory.h"
#include "stencil/weights.h"

namespace fairing {

struct SurfaceIterate;
class TotalCurvatureSteps;

// What holds the control vertices that are unknowns of the Gauss-Newton steps: the caller's
// weights, or weights that keep them within the tolerance, found step by step.
class ControlHold {
 public:
  // Holds nothing: control vertices are interpolated, or free.
  ControlHold(std::span<const Vec3> targets, const Unknowns& unknowns)
      : targets_(targets), unknowns_(unknowns) {}
  // `targets` of all control vertices, and `tolerances` of the input vertices (infinity: none), in
  // working coordinates; `weights`: the caller's, one an input vertex, or empty. `targets` and
  // `unknowns` must outlive the hold.
  ControlHold(const ControlMesh& mesh, std::span<const Vec3> targets, const Unknowns& unknowns,
              std::span<const double> weights, std::vector<double> tolerances);

  std::span<const Vec3> targets() const { return targets_; }
  const VertexWeights& weights() const { return weights_; }
  bool any() const { return !weights_.empty(); }
  bool adapts() const { return adapts_; }

  // New weights after a step.
  void adapt(const Array<double>& x);
  // Whether all are within the tolerance, or nearly so.
  bool holds(const Array<double>& x) const;
  // Puts those that are outside on the ball.
  void enforce(Array<double>& x) const;

  // The unknowns without the vertices that are held.
  Unknowns without_held() const;

 private:
  // Whether it is an unknown that may move only so far.
  bool bound(std::size_t v) const;
  Vec3 away(const Array<double>& x, std::size_t v) const;

  std::span<const Vec3> targets_;
  const Unknowns& unknowns_;
  bool adapts_ = false;
  std::vector<double> tolerance_;  // aimed at, one an input vertex
  VertexWeights base_, weights_;
};

// What the caller's weights mean to a curvature energy: 1 balances the bending of one control edge.
double curvature_weight_unit(const ControlMesh& mesh);

// From here on held control vertices stay where they are, put on the tolerance's ball where they
// are outside. The surface follows by a few plain steps, if these settle.
void fix_held(SurfaceIterate& iterate, const ControlHold& hold, TotalCurvatureSteps& steps,
              CurvatureLevelReport& report);

// The epsilon post-process of [Kobbelt 1997a, section 5]: interpolated control vertices take part
// in a step, drawn to their targets by a weight; none ends further than `epsilon` (working units)
// from its control position. The surface follows by a few plain steps, if these settle.
void release_by_epsilon(SurfaceIterate& iterate, double epsilon, TotalCurvatureSteps& steps,
                        CurvatureLevelReport& report);

}  // namespace fairing
