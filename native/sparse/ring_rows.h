// SPDX-License-Identifier: GPL-3.0-or-later
// The matrix R = sqrt(W) J of a level: three rows over the one-ring of every point, in single
// precision, with the products R x, R^T y and R^T R x. It takes 84 bytes a point in grids of
// triangles and 108 in grids of quads, against 228 for a row of R^T R. Coefficients are stored by
// neighbour along runs of points (grid/runs.h), so that loops along a run need no index.
#pragma once

#include <utility>
#include <vector>

#include "base/simd.h"
#include "grid/accumulate.h"

namespace fairing {

// `coefficient[(c * slots + s) * count + i]` is row c's number for slot s of point i; slot 0 is the
// point itself, the others are its neighbours in the order of the ring.
template <class T>
struct RowRun {
  std::size_t count = 0;
  int slots = 0;
  T* coefficient = nullptr;

  T& at(int c, int s, std::size_t i) const {
    return coefficient[(std::size_t(c * slots + s)) * count + i];
  }
};

class RingRows {
 public:
  // `rows` a point; the passes below require three.
  explicit RingRows(const GridLevel& grid, int rows = 3);

  const GridLevel& grid() const { return *grid_; }

  RowRun<const float> of(const Run& run) const;
  RowRun<float> of(const Run& run) {
    const RowRun<const float> own = std::as_const(*this).of(run);
    return {own.count, own.slots, const_cast<float*>(own.coefficient)};
  }

 private:
  struct Element {
    std::size_t begin;
    int slots;
  };

  const GridLevel* grid_;
  int rows_;
  std::vector<Element> element_;  // one each (stencil/stencils.h)
  Array<float> data_;
};

// y_c[i] = sum_s coefficient(c, s, i) x_s[i] for begin <= i < end, in packs; y holds three lanes of
// `count` numbers.
template <class T, int Bytes>
struct ForwardLoop {
  using P = Packs<T, Bytes>;
  using Pack = typename P::Pack;

  DF_INLINE static void run(const RowRun<const float>* rows, const T* const* x, T* y,
                            std::size_t begin, std::size_t end) {
    const std::size_t count = rows->count, row = std::size_t(rows->slots) * count;
    for (std::size_t i = begin; i < end; i += P::size) {
      const float* a = rows->coefficient + i;
      Pack sum[3] = {}, from, own;
      for (int s = 0; s < rows->slots; ++s, a += count) {
        P::load(x[s] + i, from);
        for (std::size_t c = 0; c < 3; ++c) {
          P::widen(a + c * row, own);
          sum[c] += own * from;
        }
      }
      for (std::size_t c = 0; c < 3; ++c) P::store(sum[c], y + c * count + i);
    }
  }
};

// out_s[i] += sum_c coefficient(c, s, i) y_c[i]
template <class T, int Bytes>
struct BackwardLoop {
  using P = Packs<T, Bytes>;
  using Pack = typename P::Pack;

  DF_INLINE static void run(const RowRun<const float>* rows, const T* y, T* const* out,
                            std::size_t begin, std::size_t end) {
    const std::size_t count = rows->count, row = std::size_t(rows->slots) * count;
    const float* a = rows->coefficient;
    for (int s = 0; s < rows->slots; ++s, a += count) {
      for (std::size_t i = begin; i < end; i += P::size) {
        Pack sum = {}, own, moment;
        for (std::size_t c = 0; c < 3; ++c) {
          P::widen(a + c * row + i, own);
          P::load(y + c * count + i, moment);
          sum += own * moment;
        }
        P::load(out[s] + i, own);
        P::store(own + sum, out[s] + i);
      }
    }
  }
};

// Whole packs first, then one number after another. A run of one point is a control vertex.
template <template <class, int> class Loop, class T, class From, class To>
void run_along(const RowRun<const float>& run, From from, To to) {
  constexpr std::size_t block = Packs<T, 32>::size;
  const std::size_t whole = run.count / block * block;
  if (whole > 0) run_loop<Loop, T>(&run, from, to, std::size_t(0), whole);
  Loop<T, sizeof(T)>::run(&run, from, to, whole, run.count);
}
template <class T>
void forward(const RowRun<const float>& run, const T* const* x, T* y) {
  run_along<ForwardLoop, T>(run, x, y);
}
template <class T>
void backward(const RowRun<const float>& run, const T* y, T* const* out) {
  run_along<BackwardLoop, T>(run, y, out);
}

// Passes over a whole level. x has one number a point, moments R x have three.

// A thread's buffers for moments.
template <class T>
struct MomentState {
  MomentState(const RingRows& rows, const T* x)
      : gather(rows.grid(), x),
        moment(room_in(thread_scratch<T>().work, 3 * std::size_t(rows.grid().n()))) {}
  RunGather<T> gather;
  T* moment;
};

// Calls put(run, moment) for every run, in parallel; moment holds three lanes of run.count numbers.
template <class T, class Put>
void visit_moments(const RingRows& rows, Workers& workers, const T* x, Put&& put) {
  for_each_run(
      rows.grid(), workers, [&] { return MomentState<T>(rows, x); },
      [&](const Run& run, MomentState<T>& state) {
        forward(rows.of(run), state.gather(run), state.moment);
        put(run, static_cast<const T*>(state.moment));
      });
}

// moment <- R x, three interleaved numbers a point.
template <class T>
void compute_moments(const RingRows& rows, Workers& workers, const T* x, T* moment) {
  visit_moments(rows, workers, x, [&](const Run& run, const T* lanes) {
    for (std::size_t i = 0; i < run.count; ++i)
      for (std::size_t c = 0; c < 3; ++c)
        moment[3 * (run.first + i) + c] = lanes[c * run.count + i];
  });
}

// out <- R^T y on the unknowns; y has three interleaved numbers a point.
template <class T>
void apply_transposed(const RingRows& rows, const Unknowns& unknowns, Workers& workers,
                      ElementSlots<T, 1>& slots, const T* y, T* out);

// out <- R^T R x on the unknowns.
template <class T>
void apply_square(const RingRows& rows, const Unknowns& unknowns, Workers& workers,
                  ElementSlots<T, 1>& slots, const T* x, T* out);

// out <- the diagonal of R^T D R on the unknowns. D has weight[p] for each point's rows; no
// weights: one.
void square_diagonal(const RingRows& rows, const Unknowns& unknowns, Workers& workers,
                     ElementSlots<float, 1>& slots, const float* weight, float* out);

// Calls visit(p, rows, i, points) for every point p in order. It is point i of its run, with these
// rows; points[s] is slot s.
template <class Visit>
void visit_rows(const RingRows& rows, Visit&& visit) {
  std::vector<Index> points;
  for_each_run(rows.grid(), [&](const Run& run) {
    for (std::size_t i = 0; i < run.count; ++i) {
      points.assign(1, Index(run.first + i));
      append_ring(rows.grid(), run, i, points);
      visit(points[0], rows.of(run), i, points);
    }
  });
}

}  // namespace fairing
