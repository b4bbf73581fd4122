// SPDX-License-Identifier: GPL-3.0-or-later
// What the paper does that the product does otherwise, kept to be compared with: charts, the solve
// without coarse-grid corrections, and the release of control vertices afterwards. For the thin
// plate.
#pragma once

namespace fairing {

enum class ChartKind {
  exponential,  // edge lengths as radii, corner angles summed and scaled to 2 pi (stencil/chart.h)
  tangent,      // orthogonal projection to the tangent plane of the control mesh
};

// How the linear system is solved.
enum class Method {
  // Full multigrid, V-cycles inside conjugate gradients, to `relative_residual`.
  multigrid,
  // Refine, then a few Gauss-Seidel sweeps, level by level [Kobbelt 1997a, §5].
  back_leg,
};

struct PaperOptions {
  ChartKind chart = ChartKind::exponential;
  double chart_blend = 1;  // 0: the uniform chart … 1: the chart itself [Kobbelt 1997b]
  Method method = Method::multigrid;
  int sweeps = 10;  // of Gauss-Seidel a level, for back_leg
  // Interpolated control vertices are released by so much afterwards, which takes cusps off; mesh
  // units.
  double epsilon = 0;

  // Whether control vertices are held by point forces: epsilon takes their cusps off, back_leg
  // solves without loads.
  bool needs_point_forces() const { return epsilon > 0 || method == Method::back_leg; }
  // Of the metric: a tangent plane shows lengths as they are.
  double metric_exponent(double chosen) const { return chart == ChartKind::tangent ? 1.0 : chosen; }
};

}  // namespace fairing
