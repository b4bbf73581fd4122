// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse/ring_rows.h"

#include "grid/runs.h"
#include "stencil/stencils.h"

namespace fairing {

RingRows::RingRows(const GridLevel& grid, int rows) : grid_(&grid), rows_(rows) {
  const ControlMesh& mesh = grid.mesh();
  element_.resize(std::size_t(mesh.vertex_count()) + mesh.edges.size() + mesh.faces.size());
  std::size_t size = 0;
  for_each_run(grid, [&](const Run& run) {
    Element& element = element_[element_of(mesh, run)];
    if (run.row <= 1) element = {size, 1 + int(neighbours(mesh, run))};
    size += std::size_t(rows * element.slots) * run.count;
  });
  data_.resize(size);
  fill_long(data_.data(), size, 0.0f);
}

RowRun<const float> RingRows::of(const Run& run) const {
  const Element& element = element_[element_of(grid_->mesh(), run)];
  const std::size_t before =
      run.row > 1 ? interior_row(run.quad, std::size_t(grid_->n()), std::size_t(run.row)) : 0;
  return {run.count, element.slots,
          data_.data() + element.begin + std::size_t(rows_ * element.slots) * before};
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
void apply_transposed(const RingRows& rows, const Unknowns& unknowns, Workers& workers,
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
void apply_square(const RingRows& rows, const Unknowns& unknowns, Workers& workers,
                  ElementSlots<T, 1>& slots, const T* x, T* out) {
  accumulate_runs(
      rows.grid(), workers, slots, &unknowns, out, [&] { return MomentState<T>(rows, x); },
      [&](const Run& run, T* const* target, MomentState<T>& state) {
        const RowRun<const float> own = rows.of(run);
        forward(own, state.gather(run), state.moment);
        backward(own, state.moment, target);
      });
}

void square_diagonal(const RingRows& rows, const Unknowns& unknowns, Workers& workers,
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

#define DF_INSTANTIATE(T)                                                                        \
  template void apply_transposed<T>(const RingRows&, const Unknowns&, Workers&,                  \
                                    ElementSlots<T, 1>&, const T*, T*);                          \
  template void apply_square<T>(const RingRows&, const Unknowns&, Workers&, ElementSlots<T, 1>&, \
                                const T*, T*);
DF_INSTANTIATE(float)
DF_INSTANTIATE(double)
#undef DF_INSTANTIATE

}  // namespace fairing
