// SPDX-License-Identifier: GPL-3.0-or-later
// point_curvature() and linearize() for a few points of a run at once, one a lane of the machine's vectors. All points of
// a run have rings of one make, so that a lane does what one point alone would, but for what decides between ways: points
// that go another way than the usual one are left to the functions for one point.
#pragma once

#include <cstdint>

#include "energy/ring_rows.h"
#include "energy/shape_rows.h"
#include "energy/surface_walk.h"

namespace fairing {

constexpr int pack_points = 4;

// The closed rings of a run's points: coordinate a of slot s of point i is at[s][a][i], slot 0 the point itself, the others
// counter-clockwise. Readable for pack_points - 1 points beyond the run.
struct RunRings {
  int size = 0;  // neighbours, at most 8
  bool far[most_slots] = {};
  const double* at[most_slots][3] = {};
  const float* lift[most_slots] = {};  // null: none
};

// Lane l is the run's point first + l. Where `done` is zero, everything else is zero as well.
struct ShapePack {
  double normal[3][pack_points], shape[3][pack_points], area[pack_points];
  double row[most_slots][3][pack_points];  // slot 0: of the point's own displacement
  double cotangent[most_slots][pack_points];
  double axis[3][pack_points];  // the chart's u axis in space
  bool done[pack_points];
};

// The axis only if it is wanted.
void linearize(const RunRings& run, std::size_t first, CurvatureEnergy energy, bool wants_axis,
               ShapePack& out);

}  // namespace fairing
