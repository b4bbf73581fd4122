// SPDX-License-Identifier: GPL-3.0-or-later
// The rings of a level's runs, for shape_packs.h: rows inside faces, and the insides of edges between two faces.
#pragma once

#include <vector>

#include "energy/shape_packs.h"
#include "execution/cancel.h"
#include "execution/scratch.h"

namespace fairing {

struct RunScratch {
  std::vector<double> interleaved, coordinate[3];
  std::vector<float> lift;
  RunRings rings;
};

namespace runs {

// Interleaved coordinates apart.
inline void take_apart(std::size_t size, const double* interleaved, double* const* to) {
  for (std::size_t i = 0; i < size; ++i)
    for (std::size_t a = 0; a < 3; ++a) to[a][i] = interleaved[3 * i + a];
}

// Room for so many numbers and for a pack that reads beyond the last one.
template <class T>
T* room(std::vector<T>& buffer, std::size_t size) {
  return room_in(buffer, size + pack_points);
}

}  // namespace runs

// Calls visit(j, rings) for the rows j = 1 … inside a face. `lift`: one number a point, or null.
template <class Visit>
void visit_face_runs(const Lattice& lattice, Index f, const double* x, const float* lift, RunScratch& scratch,
                     Visit&& visit) {
  const bool quad = lattice.mesh().faces[std::size_t(f)].quad();
  const int n = lattice.n();
  const std::size_t size = closed_size(quad, std::size_t(n));
  double* coordinate[3];
  for (std::size_t a = 0; a < 3; ++a) coordinate[a] = runs::room(scratch.coordinate[a], size);
  gather_face(lattice, x, f, runs::room(scratch.interleaved, 3 * size));
  runs::take_apart(size, scratch.interleaved.data(), coordinate);
  if (lift) gather_face<1>(lattice, lift, f, runs::room(scratch.lift, size));
  RunRings& rings = scratch.rings;
  rings = {};
  const auto steps = face_ring(quad);
  rings.size = int(steps.size());
  for (std::size_t s = 0; s < steps.size(); ++s) rings.far[s + 1] = quad && steps[s].i * steps[s].j != 0;
  for (int j = 1; j < n && row_count(quad, n, j) > 0; ++j) {
    stop_in_large_face(j);
    for (std::size_t a = 0; a < 3; ++a) {
      const auto beside = beside_row<const double>(quad, n, j, coordinate[a]);
      for (int s = 0; s <= rings.size; ++s) rings.at[s][a] = beside.at[s];
    }
    if (lift) {
      const auto beside = beside_row<const float>(quad, n, j, scratch.lift.data());
      for (int s = 0; s <= rings.size; ++s) rings.lift[s] = beside.at[s];
    }
    visit(j, static_cast<const RunRings&>(rings));
  }
}

// The rings of the points inside an edge that has faces on both sides.
inline const RunRings& edge_rings(const Lattice& lattice, Index e, const double* x, const float* lift,
                                  RunScratch& scratch) {
  const EdgeRingLanes ring(lattice.mesh(), e);
  const EdgeLanes<double> lanes(lattice, x, e, scratch.interleaved);
  const std::size_t points = std::size_t(lattice.n() + 1), stride = points + pack_points;
  for (auto& own : scratch.coordinate) runs::room(own, 3 * stride);
  for (std::size_t l = 0; l < 3; ++l) {
    double* to[3];
    for (std::size_t a = 0; a < 3; ++a) to[a] = scratch.coordinate[a].data() + l * stride;
    runs::take_apart(points, lanes.lane[l], to);
  }
  RunRings& rings = scratch.rings;
  rings = {};
  rings.size = ring.size;
  for (int s = 0; s < ring.size; ++s) rings.far[s + 1] = ring.far[s];
  for (std::size_t a = 0; a < 3; ++a) {
    const double* own = scratch.coordinate[a].data();
    const double* const lane[3] = {own, own + stride, own + 2 * stride};
    const auto beside = beside_edge<const double>(ring, lane);
    for (int s = 0; s <= ring.size; ++s) rings.at[s][a] = beside.at[s];
  }
  if (lift) {
    const EdgeLanes<float, 1> lifts(lattice, lift, e, scratch.lift);
    const auto beside = beside_edge<float>(ring, lifts.lane);
    for (int s = 0; s <= ring.size; ++s) rings.lift[s] = beside.at[s];
  }
  return rings;
}

// Point i's ring alone.
inline void ring_at(const RunRings& rings, std::size_t i, RingInSpace& ring) {
  const auto offset = [&](int s) {
    Vec3 d;
    for (int a = 0; a < 3; ++a) d[a] = rings.at[s][a][i] - rings.at[0][a][i];
    return d;
  };
  ring.start(rings.lift[0] ? rings.lift[0][i] : 0);
  for (int s = 1; s <= rings.size; ++s) {
    ring.add(offset(s), rings.far[s], s);
    if (rings.lift[0]) ring.add_lift(rings.lift[s][i]);
  }
}

}  // namespace fairing
