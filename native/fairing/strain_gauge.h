// SPDX-License-Identifier: GPL-3.0-or-later
// Loads as lengths: over the load that a vertex asks for when it alone moves, a load is the way by
// which the surface would spring there, were that one vertex let go. On curves it is the way that
// makes their loads (strain/curve_loads.h) least.
#pragma once

#include <vector>

#include "fairing/problem.h"
#include "strain/curve_loads.h"

namespace fairing {

struct Strain {
  // One an input vertex, in mesh units: the way itself, and its part along the control mesh's
  // normal; on curves the whole, over zero on the normal's side. NaN at corners, at
  // and next to ends of curves, and outside a region.
  std::vector<Vec3> ways;
  std::vector<double> lengths;
  std::vector<std::uint8_t> on_curve;  // over zero where a curve says it

  // Each vertex that was merged with another gets what that one has: `origin` one a vertex.
  void restore(const std::vector<Index>& origin);
};

class StrainGauge {
 public:
  // `own`: what each control vertex on a pad asks for when it alone moves, 0 for others.
  StrainGauge(const FairingProblem& problem, std::vector<double> own);

  const CurveLoads& curves() const { return curves_; }
  // The middles() of curves that are faired, and the pulls of loads on them: one row each of D'D x,
  // with D the loads' matrix.
  const std::vector<Index>& curve_vertices() const { return curve_vertices_; }
  const LoadMatrix& pulls() const { return pulls_; }
  Columns pulls_of(std::span<const Vec3> positions) const;

  // Of loads on pads, and of control positions in working coordinates.
  Strain read(const Loads& loads, std::span<const Vec3> positions) const;

 private:
  const FairingProblem& problem_;
  std::vector<double> own_;
  CurveLoads curves_;
  std::vector<Index> curve_vertices_;
  LoadMatrix pulls_;  // D'D
};

// The control mesh's own unit normal at a vertex; zero where its faces have no area.
Vec3 normal_of(const ControlMesh& mesh, Index v);

}  // namespace fairing
