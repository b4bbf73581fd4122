// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "chart/chart.h"
#include "control_mesh/control_mesh.h"

namespace fairing {

enum class Interpolation { exact, approximate };

enum class Energy {
  thin_plate,         // in the control metric: one linear system
  total_curvature,    // of the surface itself: Gauss-Newton steps from the thin plate's surface
  minimum_variation,  // of the curvature along the surface: likewise
};

enum class Method {
  multigrid,  // full multigrid, V-cycles inside conjugate gradients: the solution of the linear system
  back_leg,   // the paper's own: refine, then a few Gauss-Seidel sweeps, level by level
};

struct FairOptions {
  int levels = 3;
  Energy energy = Energy::thin_plate;
  double step_tolerance =
      1e-6;            // Gauss-Newton steps end where less is left to move; share of the mesh's size
  int max_steps = 20;  // on the finest level
  ChartOptions chart;
  FeatureOptions features;
  bool repair_orientation = false;

  Interpolation interpolation = Interpolation::exact;
  double tolerance = 0;         // approximate: the farthest that a control vertex may move, in mesh units
  std::vector<double> weights;  // approximate: one a vertex, or empty; 0 frees a vertex where tolerance is 0
  double epsilon = 0;  // afterwards control vertices are let go by as much, to take off cusps; mesh units

  std::span<const double> shapes{};  // further positions of all vertices, shape after shape; the caller's
  std::size_t shape_count(std::size_t coordinates) const {
    return coordinates ? shapes.size() / coordinates : 0;
  }

  Method method = Method::multigrid;
  double relative_residual = 1e-8;
  int max_iterations = 200;
  int smoother_degree = 0;  // 0: chosen from how the coarse levels converge
  int sweeps = 10;          // back_leg: Gauss-Seidel sweeps a level

  int threads = 0;               // 0: one a core
  std::size_t memory_limit = 0;  // bytes; 0: three quarters of the machine's memory
  bool measure = true;           // total curvature of result, control polyhedron and prediction
};

}  // namespace fairing
