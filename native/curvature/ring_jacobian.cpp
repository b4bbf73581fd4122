// SPDX-License-Identifier: GPL-3.0-or-later
#include "curvature/ring_jacobian.h"

#include "parallel/cancel.h"

namespace fairing {

RingJacobian::RingJacobian(const GridLevel& grid, int rows) : grid_(&grid), rows_(rows) {
  const ControlMesh& mesh = grid.mesh();
  const std::size_t n = std::size_t(grid.n()), each = std::size_t(rows);
  std::size_t offset = 0;
  for (Index v = 0; v < mesh.vertex_count(); ++v) {
    stop_if_cancelled(std::size_t(v));
    vertex_offset_.push_back(offset);
    std::size_t slots = 1;
    visit_ring(grid, v, [&](Index, std::size_t) { ++slots; });
    offset += each * slots;
  }
  vertex_offset_.push_back(offset);
  for (std::size_t e = 0; e < mesh.edges.size(); ++e) {
    stop_if_cancelled(e);
    edge_offset_.push_back(offset);
    offset += each * std::size_t(1 + EdgeRingLanes(mesh, Index(e)).size) * (n - 1);
  }
  edge_offset_.push_back(offset);
  for (const Face& face : mesh.faces) {
    face_offset_.push_back(offset);
    offset += each * (1 + face_ring(face.quad()).size()) *
              std::size_t(interior_size(face.quad(), grid.n()));
  }
  face_offset_.push_back(offset);
  data_.resize(offset);
  fill_long(data_.data(), offset, 0.0f);
}

RowRun<float> RingJacobian::face(Index f, int j) {
  const bool quad = grid_->mesh().faces[std::size_t(f)].quad();
  const int slots = 1 + int(face_ring(quad).size());
  const std::size_t before = interior_row(quad, std::size_t(grid_->n()), std::size_t(j));
  return {row_count(quad, grid_->n(), j), slots,
          data_.data() + face_offset_[std::size_t(f)] + std::size_t(rows_ * slots) * before};
}

namespace {

// Splits interleaved numbers into three lanes.
template <class T>
void split(std::size_t count, const T* y, T* lanes) {
  for (std::size_t i = 0; i < count; ++i)
    for (std::size_t c = 0; c < 3; ++c) lanes[c * count + i] = y[3 * i + c];
}

}  // namespace

template <class T>
void apply_transposed(const RingJacobian& rows, const Unknowns& unknowns, Workers& workers,
                      ElementSlots<T, 1>& slots, const T* y, T* out) {
  const std::size_t size = 3 * std::size_t(rows.grid().n());
  accumulate_runs(
      rows.grid(), workers, slots, &unknowns, out,
      [&] { return room_in(thread_scratch<T>().work, size); },
      [&](const Run& run, T* const* target, T* moment) {
        split(run.count, y + 3 * run.first, moment);
        backward(rows.of(run), moment, target);
      });
}

template <class T>
void apply_square(const RingJacobian& rows, const Unknowns& unknowns, Workers& workers,
                  ElementSlots<T, 1>& slots, const T* x, T* out) {
  accumulate_runs(
      rows.grid(), workers, slots, &unknowns, out, [&] { return MomentState<T>(rows, x); },
      [&](const Run& run, T* const* target, MomentState<T>& state) {
        const RowRun<const float> own = rows.of(run);
        forward(own, state.gather(run), state.moment);
        backward(own, state.moment, target);
      });
}

void square_diagonal(const RingJacobian& rows, const Unknowns& unknowns, Workers& workers,
                     ElementSlots<float, 1>& slots, const float* weight, float* out) {
  accumulate_runs(
      rows.grid(), workers, slots, &unknowns, out, [] { return 0; },
      [&](const Run& run, float* const* target, int) {
        const RowRun<const float> own = rows.of(run);
        for (int s = 0; s < own.slots; ++s)
          for (std::size_t i = 0; i < own.count; ++i) {
            float square = 0;
            for (int c = 0; c < 3; ++c) square += own.at(c, s, i) * own.at(c, s, i);
            target[s][i] += weight ? weight[run.first + i] * square : square;
          }
      });
}

#define DF_INSTANTIATE(T)                                                           \
  template void apply_transposed<T>(const RingJacobian&, const Unknowns&, Workers&, \
                                    ElementSlots<T, 1>&, const T*, T*);             \
  template void apply_square<T>(const RingJacobian&, const Unknowns&, Workers&,     \
                                ElementSlots<T, 1>&, const T*, T*);
DF_INSTANTIATE(float)
DF_INSTANTIATE(double)
#undef DF_INSTANTIATE

}  // namespace fairing
