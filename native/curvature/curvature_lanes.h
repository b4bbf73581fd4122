// SPDX-License-Identifier: GPL-3.0-or-later
// point_curvature() and linearize() for several points of a run at once, one in each lane of the
// machine's vectors. All points of a run have rings of the same kind. Points with unusual rings
// (see `done`) are left to the functions for one point.
#pragma once

#include <cstdint>

#include "curvature/point_curvature.h"
#include "grid/runs.h"

namespace fairing {

constexpr int lane_count = 4;

// The closed rings of a run's points: coordinate a of slot s of point i is at[s][a][i]. Slot 0 is
// the point itself, the others are counter-clockwise. Readable lane_count - 1 points further.
struct RunRings {
  int size = 0;  // number of neighbours, at most 8
  std::uint8_t far[most_slots] = {};
  const double* at[most_slots][3] = {};
  const float* lift[most_slots] = {};  // null: zero
};

// Lane l is point first + l of the run; the last lanes may reach beyond the run. `done` is false
// for points with a coincident neighbour, a triangle without an area, an area below the floor, or a
// ring that does not determine a quadratic; then all other members are zero.
struct CurvatureLanes {
  double normal[3][lane_count], shape[3][lane_count], area[lane_count];
  double row[most_slots][3][lane_count];  // slot 0: for the point's own displacement
  double cotangent[most_slots][lane_count];
  double axis[3][lane_count];  // the chart's u axis in space
  bool done[lane_count];
};

// Computes the lanes of points first … first + lane_count - 1; `axis` if requested. Throws nothing.
void linearize(const RunRings& run, std::size_t first, CurvatureEnergy energy, bool wants_axis,
               CurvatureLanes& out);

}  // namespace fairing
