// SPDX-License-Identifier: GPL-3.0-or-later
// Options of the paper that the product replaced, kept for comparison: charts, the solve without
// coarse-grid corrections, and the subsequent release of control vertices. For the thin plate only.
#pragma once

namespace fairing {

enum class ChartKind {
  exponential,  // edge lengths as radii, corner angles summed and scaled to 2 pi (stencil/chart.h)
  tangent,      // orthogonal projection to the tangent plane of the control mesh
};

// The solver of the linear system.
enum class Method {
  // Full multigrid, then conjugate gradients with V-cycles, to `relative_residual`.
  multigrid,
  // Refine, then a few Gauss-Seidel sweeps, level by level [Kobbelt 1997a, §5].
  back_leg,
};

struct PaperOptions {
  ChartKind chart = ChartKind::exponential;
  double chart_blend = 1;  // 0: the uniform chart … 1: the chart itself [Kobbelt 1997b]
  Method method = Method::multigrid;
  int sweeps = 10;  // Gauss-Seidel sweeps a level, for back_leg
  // Interpolated control vertices are then released by at most this, without cusps; mesh units.
  double epsilon = 0;

  // Whether control vertices have point forces: back_leg solves without loads.
  bool needs_point_forces() const { return epsilon > 0 || method == Method::back_leg; }
  // Exponent of the metric: a tangent plane keeps lengths.
  double metric_exponent(double chosen) const { return chart == ChartKind::tangent ? 1.0 : chosen; }
};

}  // namespace fairing
