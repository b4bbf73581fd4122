// SPDX-License-Identifier: GPL-3.0-or-later
// point_curvature() and linearize() for a few points of a run at once, one a lane of the machine's
// vectors. All points of a run have rings of the same kind. Points with anything unusual about
// their ring (see `done`) are left to the functions for one point.
#pragma once

#include <cstdint>

#include "curvature/point_curvature.h"
#include "grid/runs.h"

namespace fairing {

constexpr int lane_count = 4;

// The closed rings of a run's points: coordinate a of slot s of point i is at[s][a][i], slot 0 the
// point itself, the others counter-clockwise. Readable for lane_count - 1 points beyond the run.
struct RunRings {
  int size = 0;  // neighbours, at most 8
  std::uint8_t far[most_slots] = {};
  const double* at[most_slots][3] = {};
  const float* lift[most_slots] = {};  // null: none
};

// Lane l is the run's point first + l; the last run of lanes may reach beyond the run. `done` is
// false for points with a neighbour at the point itself, a triangle without an area, an area below
// its floor, or a ring that does not determine a quadratic; everything else is zero there.
struct CurvatureLanes {
  double normal[3][lane_count], shape[3][lane_count], area[lane_count];
  double row[most_slots][3][lane_count];  // slot 0: of the point's own displacement
  double cotangent[most_slots][lane_count];
  double axis[3][lane_count];  // the chart's u axis in space
  bool done[lane_count];
};

// The lanes of the points first … first + lane_count - 1. `axis` is set only if it is wanted.
// Throws nothing.
void linearize(const RunRings& run, std::size_t first, CurvatureEnergy energy, bool wants_axis,
               CurvatureLanes& out);

}  // namespace fairing
