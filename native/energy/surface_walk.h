// SPDX-License-Identifier: GPL-3.0-or-later
// The rings in space of a level's points, one after another, in memory that is taken once.
#pragma once

#include "energy/point_curvature.h"
#include "execution/cancel.h"
#include "execution/memory.h"
#include "execution/workers.h"
#include "lattice/ring.h"

namespace fairing {

// One ring. `slot[j]` is where neighbour j stands in the order of the lattice (RingRows).
class RingInSpace {
 public:
  void start(float lift) {
    own_lift_ = lift;
    lift_.clear();
    offset_.clear();
    far_.clear();
    slot_.clear();
  }
  void start(const double* centre, float lift = 0) {
    centre_ = centre;
    start(lift);
  }
  void add(const Vec3& offset, bool far, int slot) {
    offset_.push_back(offset);
    far_.push_back(far);
    slot_.push_back(slot);
  }
  void add(const double* p, bool far, int slot) {
    add(Vec3(p[0] - centre_[0], p[1] - centre_[1], p[2] - centre_[2]), far, slot);
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

struct WalkScratch {
  RingInSpace ring;
  std::vector<double> points;
  std::vector<float> lifts;
};

// Calls visit(ring, closed) for a control vertex, visit(i, ring, closed) for the points i = 0 … n - 2 inside an edge, and
// visit(j, i, ring, closed) for those of a face's rows j = 1 …, i = 0 …. `lift`: one number a point, or null.
template <class Visit>
void walk_vertex(const Lattice& lattice, Index v, const double* x, const float* lift, WalkScratch& scratch,
                 Visit&& visit) {
  RingInSpace& ring = scratch.ring;
  ring.start(x + 3 * std::size_t(v), lift ? lift[v] : 0);
  int slot = 0;
  visit_ring(lattice, v, [&](Index p, std::size_t place) {
    ring.add(x + 3 * std::size_t(p), place % 2 == 1, ++slot);
    if (lift) ring.add_lift(lift[p]);
  });
  visit(ring, lattice.mesh().interior(v));
}

template <class Visit>
void walk_edge(const Lattice& lattice, Index e, const double* x, const float* lift, WalkScratch& scratch,
               Visit&& visit) {
  RingInSpace& ring = scratch.ring;
  const EdgeRingLanes lanes_of_ring(lattice.mesh(), e);
  const EdgeLanes<double> lanes(lattice, x, e, scratch.points);
  // without lifts these lanes are not read
  const EdgeLanes<float, 1> lifts =
      lift ? EdgeLanes<float, 1>(lattice, lift, e, scratch.lifts) : EdgeLanes<float, 1>{};
  const Edge& edge = lattice.mesh().edges[std::size_t(e)];
  // An open ring starts on the boundary: without a left face, behind.
  const int size = lanes_of_ring.size, start = edge.side[0] < 0 ? 1 : 0;
  for (int k = 1; k < lattice.n(); ++k) {
    ring.start(lanes.lane[0] + 3 * k, lift ? lifts.lane[0][k] : 0);
    for (int m = 0; m < size; ++m) {
      const int j = (start + m) % size, lane = lanes_of_ring.lane[j], at = lanes_of_ring.at[j] + k;
      ring.add(lanes.lane[lane] + 3 * at, lanes_of_ring.far[j], j + 1);
      if (lift) ring.add_lift(lifts.lane[lane][at]);
    }
    visit(std::size_t(k - 1), ring, !edge.boundary());
  }
}

template <class Visit>
void walk_face(const Lattice& lattice, Index f, const double* x, const float* lift, WalkScratch& scratch,
               Visit&& visit) {
  RingInSpace& ring = scratch.ring;
  const bool quad = lattice.mesh().faces[std::size_t(f)].quad();
  const int n = lattice.n();
  const std::size_t size = closed_size(true, std::size_t(n));
  if (scratch.points.size() < 3 * size) scratch.points.resize(3 * size);
  gather_face(lattice, x, f, scratch.points.data());
  if (lift) {
    if (scratch.lifts.size() < size) scratch.lifts.resize(size);
    gather_face<1>(lattice, lift, f, scratch.lifts.data());
  }
  const auto at = [&](int i, int j) {
    return closed_row(quad, std::size_t(n), std::size_t(j)) + std::size_t(i);
  };
  const auto steps = face_ring(quad);
  for (int j = 1; j < n; ++j) {
    stop_in_large_face(j);
    for (int i = 1; i < (quad ? n : n - j); ++i) {
      ring.start(&scratch.points[3 * at(i, j)], lift ? scratch.lifts[at(i, j)] : 0);
      int slot = 0;
      for (const LatticePoint d : steps) {
        const std::size_t p = at(i + d.i, j + d.j);
        ring.add(&scratch.points[3 * p], quad && d.i * d.j != 0, ++slot);
        if (lift) ring.add_lift(scratch.lifts[p]);
      }
      visit(j, std::size_t(i - 1), ring, true);
    }
  }
}

// The lifts of all points (point_curvature.h); empty where there is none. Inside faces nothing is irregular, and the
// area needs no lift but where the surface is crumpled.
Array<float> area_lifts(const Lattice& lattice, Workers& workers, const double* x);

}  // namespace fairing
