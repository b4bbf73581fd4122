// SPDX-License-Identifier: GPL-3.0-or-later
#include "curvature/rings.h"

#include <algorithm>

namespace fairing {
namespace {

// Splits interleaved coordinates.
void split(std::size_t size, const double* interleaved, double* const* to) {
  for (std::size_t i = 0; i < size; ++i)
    for (std::size_t a = 0; a < 3; ++a) to[a][i] = interleaved[3 * i + a];
}

// Space for `size` numbers, and for lanes that read beyond the last one.
template <class T>
T* lane_room(std::vector<T>& buffer, std::size_t size) {
  return room_in(buffer, size + lane_count);
}

}  // namespace

void RingLanes::set_row(const Run& run) {
  const int n = grid_.n();
  if (run.row == 1) {
    const std::size_t size = closed_size(run.quad, std::size_t(n));
    double* to[3];
    for (std::size_t a = 0; a < 3; ++a) to[a] = lane_room(coordinate_[a], size);
    gather_face(grid_, x_, run.element, lane_room(interleaved_, 3 * size));
    split(size, interleaved_.data(), to);
    if (lift_) gather_face<1>(grid_, lift_, run.element, lane_room(lifts_, size));
    rings_ = {};
    for (const GridPoint d : face_ring(run.quad)) rings_.far[++rings_.size] = is_far(run.quad, d);
  }
  for (std::size_t a = 0; a < 3; ++a) {
    const auto beside = beside_row<const double>(run.quad, n, run.row, coordinate_[a].data());
    for (int s = 0; s <= rings_.size; ++s) rings_.at[s][a] = beside.at[s];
  }
  if (!lift_) return;
  const auto beside = beside_row<const float>(run.quad, n, run.row, lifts_.data());
  for (int s = 0; s <= rings_.size; ++s) rings_.lift[s] = beside.at[s];
}

void RingLanes::set_edge(const Run& run) {
  const EdgeRingLanes& ring = *run.ring;
  const EdgeLanes<double> lane(grid_, x_, run.element, interleaved_);
  const std::size_t points = std::size_t(grid_.n() + 1), stride = points + lane_count;
  for (auto& own : coordinate_) lane_room(own, 3 * stride);
  for (std::size_t l = 0; l < 3; ++l) {
    double* to[3];
    for (std::size_t a = 0; a < 3; ++a) to[a] = coordinate_[a].data() + l * stride;
    split(points, lane.lane[l], to);
  }
  rings_ = {};
  rings_.size = ring.size;
  for (int s = 0; s < ring.size; ++s) rings_.far[s + 1] = ring.far[s];
  for (std::size_t a = 0; a < 3; ++a) {
    const double* own = coordinate_[a].data();
    const double* const of_lane[3] = {own, own + stride, own + 2 * stride};
    const auto beside = beside_edge<const double>(ring, of_lane);
    for (int s = 0; s <= ring.size; ++s) rings_.at[s][a] = beside.at[s];
  }
  if (!lift_) return;
  const EdgeLanes<float, 1> lifts(grid_, lift_, run.element, lifts_);
  const auto beside = beside_edge<float>(ring, lifts.lane);
  for (int s = 0; s <= ring.size; ++s) rings_.lift[s] = beside.at[s];
}

Array<float> area_lifts(const GridLevel& grid, Workers& workers, const double* x) {
  const ControlMesh& mesh = grid.mesh();
  Array<float> lifts(std::size_t(mesh.vertex_count()) +
                     mesh.edges.size() * std::size_t(grid.n() - 1));
  const auto set = [&](const Run& run, bool has_fit, RingWalk& walk, SurfaceChart& chart) {
    std::fill_n(lifts.data() + run.first, run.count, 0.0f);
    if (!has_fit) return;
    walk(run, [&](std::size_t i, const RingInSpace& ring, bool closed) {
      lifts[run.first + i] = area_lift(ring.view(closed), chart);
    });
  };
  for_vertex_parts(grid, workers, [&](Index begin, Index end) {
    RingWalk walk(grid, x, nullptr);
    SurfaceChart chart;
    for (Index v = begin; v < end; ++v) set(vertex_run(v), mesh.vertex_fit(v), walk, chart);
  });
  for_edge_parts(grid, workers, [&](Index begin, Index end) {
    RingWalk walk(grid, x, nullptr);
    SurfaceChart chart;
    for (Index e = begin; e < end; ++e)
      for_edge_run(grid, e, [&](const Run& run) { set(run, mesh.edge_fit(e), walk, chart); });
  });
  if (std::none_of(lifts.begin(), lifts.end(), [](float lift) { return lift > 0; })) return {};
  const std::size_t before_faces = lifts.size();
  lifts.resize(grid.size());
  std::fill(lifts.begin() + before_faces, lifts.end(), 0.0f);
  return lifts;
}

}  // namespace fairing
