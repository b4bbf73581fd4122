// SPDX-License-Identifier: GPL-3.0-or-later
// The rings in space of a level's points, run by run (grid/runs.h), in memory that is allocated
// once: each ring alone, for any point; or all rings of a run together, coordinate by coordinate,
// for points with regular rings.
#pragma once

#include <vector>

#include "curvature/curvature_lanes.h"
#include "grid/ring_shape.h"
#include "parallel/memory.h"

namespace fairing {

// One ring. `slot()[j]` is the place of neighbour j in the order of the grid (RingRows).
class RingInSpace {
 public:
  void start(const double* centre, float lift) {
    centre_ = centre;
    own_lift_ = lift;
    lift_.clear();
    offset_.clear();
    far_.clear();
    slot_.clear();
  }
  void add(const double* p, bool far, int slot) {
    offset_.push_back(Vec3(p[0] - centre_[0], p[1] - centre_[1], p[2] - centre_[2]));
    far_.push_back(far);
    slot_.push_back(slot);
  }
  void add_lift(float lift) { lift_.push_back(lift); }
  SurfaceRing view(bool closed) const { return {offset_, far_, closed, lift_, own_lift_}; }
  const std::vector<int>& slot() const { return slot_; }

 private:
  const double* centre_ = nullptr;
  std::vector<Vec3> offset_;
  std::vector<std::uint8_t> far_;
  std::vector<int> slot_;
  std::vector<float> lift_;
  float own_lift_ = 0;
};

// Copies point i's ring.
inline void ring_at(const RunRings& rings, std::size_t i, RingInSpace& ring) {
  const auto point = [&](int s, double* p) {
    for (int a = 0; a < 3; ++a) p[a] = rings.at[s][a][i];
  };
  double centre[3], neighbour[3];
  point(0, centre);
  ring.start(centre, rings.lift[0] ? rings.lift[0][i] : 0);
  for (int s = 1; s <= rings.size; ++s) {
    point(s, neighbour);
    ring.add(neighbour, rings.far[s], s);
    if (rings.lift[0]) ring.add_lift(rings.lift[s][i]);
  }
}

// Visits each ring of a run alone: calls visit(i, ring, closed) for its points i. x: 3 numbers a
// point; `lift`: one, or null. Both must outlive the walk. For one thread.
class RingWalk {
 public:
  RingWalk(const GridLevel& grid, const double* x, const float* lift)
      : grid_(grid),
        lift_(lift),
        points_(grid, x, point_buffer_),
        lifts_(grid, lift, lift_buffer_) {}
  RingWalk(const RingWalk&) = delete;

  template <class Visit>
  void operator()(const Run& run, Visit&& visit) {
    shape_.set(grid_, run);
    const double* const* x = points_(run);
    const float* const* lift = lift_ ? lifts_(run) : nullptr;
    const int size = int(shape_.far.size());
    for (std::size_t i = 0; i < run.count; ++i) {
      ring_.start(x[0] + 3 * i, lift ? lift[0][i] : 0);
      for (int m = 0; m < size; ++m) {
        const int j = (shape_.first + m) % size;
        ring_.add(x[j + 1] + 3 * i, shape_.far[j], j + 1);
        if (lift) ring_.add_lift(lift[j + 1][i]);
      }
      visit(i, static_cast<const RingInSpace&>(ring_), shape_.closed);
    }
  }

 private:
  const GridLevel& grid_;
  const float* lift_;
  std::vector<double> point_buffer_;
  std::vector<float> lift_buffer_;
  RunGather<double, 3> points_;
  RunGather<float> lifts_;
  RingInSpace ring_;
  RingShape shape_;
};

// All rings of a run together, for runs inside faces and inside edges between two faces. Valid
// until the next run; rows of a face must follow one another. For one thread.
class RingLanes {
 public:
  RingLanes(const GridLevel& grid, const double* x, const float* lift)
      : grid_(grid), x_(x), lift_(lift) {}

  const RunRings& operator()(const Run& run) {
    if (run.kind == RunKind::edge)
      set_edge(run);
    else
      set_row(run);
    return rings_;
  }

 private:
  void set_edge(const Run& run);
  void set_row(const Run& run);

  const GridLevel& grid_;
  const double* x_;
  const float* lift_;
  std::vector<double> interleaved_, coordinate_[3];
  std::vector<float> lifts_;
  RunRings rings_;
};

// The lifts of all points (point_curvature.h); empty if all are zero. Regular points inside faces
// need none except where the surface is crumpled.
Array<float> area_lifts(const GridLevel& grid, Workers& workers, const double* x);

}  // namespace fairing
