// SPDX-License-Identifier: GPL-3.0-or-later
// Three rows over the one-ring of every point of a level, in single precision: 84 bytes a point in triangles' lattices,
// 108 in quads', against 228 for a row of the matrix that they stand for. Coefficients lie by neighbour along runs of
// points, so that loops along a run need no index: all neighbours of a run are runs as well, one step aside.
//
// A run is the inside of an edge, or a row inside a face; control vertices are runs of one point.
#pragma once

#include <memory>
#include <span>

#include "execution/wide.h"
#include "lattice/accumulate.h"
#include "lattice/ring.h"

namespace fairing {

// `coefficient[(c * slots + s) * count + i]` is row c's number for slot s of point i; slot 0 is the point itself, the
// others are its neighbours in the order of their ring.
template <class T>
struct RowRun {
  std::size_t count = 0;
  int slots = 0;
  T* coefficient = nullptr;

  T& at(int c, int s, std::size_t i) const { return coefficient[(std::size_t(c * slots + s)) * count + i]; }
};

constexpr int most_slots = 9;  // of edges and faces; vertices may have any number

class RingRows {
 public:
  explicit RingRows(const Lattice& lattice);

  const Lattice& lattice() const { return *lattice_; }

  RowRun<float> vertex(Index v) {
    return {1, int(vertex_offset_[std::size_t(v) + 1] - vertex_offset_[std::size_t(v)]) / 3,
            data_.data() + vertex_offset_[std::size_t(v)]};
  }
  RowRun<float> edge(Index e) {
    const std::size_t count = std::size_t(lattice_->n() - 1);
    if (count == 0) return {};
    return {count, int((edge_offset_[std::size_t(e) + 1] - edge_offset_[std::size_t(e)]) / (3 * count)),
            data_.data() + edge_offset_[std::size_t(e)]};
  }
  // Row j = 1 … of a face.
  RowRun<float> face(Index f, int j);
  RowRun<const float> vertex(Index v) const { return constant(const_cast<RingRows*>(this)->vertex(v)); }
  RowRun<const float> edge(Index e) const { return constant(const_cast<RingRows*>(this)->edge(e)); }
  RowRun<const float> face(Index f, int j) const { return constant(const_cast<RingRows*>(this)->face(f, j)); }

 private:
  static RowRun<const float> constant(const RowRun<float>& run) {
    return {run.count, run.slots, run.coefficient};
  }

  const Lattice* lattice_;
  std::vector<std::size_t> vertex_offset_, edge_offset_, face_offset_;  // each has one more than elements
  Array<float> data_;
};

// Number of points in row j inside a face.
constexpr std::size_t row_count(bool quad, int n, int j) { return std::size_t(quad ? n - 1 : n - 1 - j); }

// y_c[i] = sum_s coefficient(c, s, i) x_s[i] for i from `begin` on; y holds three lanes of `count`.
template <class T>
inline void forward(const RowRun<const float>& run, const T* const* x, T* y, std::size_t begin = 0) {
  const std::size_t count = run.count;
  for (int c = 0; c < 3; ++c) {
    T* to = y + std::size_t(c) * count;
    for (std::size_t i = begin; i < count; ++i) to[i] = T(run.at(c, 0, i)) * x[0][i];
    for (int s = 1; s < run.slots; ++s) {
      const float* a = &run.at(c, s, 0);
      const T* from = x[s];
      for (std::size_t i = begin; i < count; ++i) to[i] += T(a[i]) * from[i];
    }
  }
}

// out_s[i] += sum_c coefficient(c, s, i) y_c[i] for i from `begin` on
template <class T>
inline void backward(const RowRun<const float>& run, const T* y, T* const* out, std::size_t begin = 0) {
  const std::size_t count = run.count;
  for (int s = 0; s < run.slots; ++s) {
    const float *a = &run.at(0, s, 0), *b = &run.at(1, s, 0), *c = &run.at(2, s, 0);
    T* to = out[s];
    for (std::size_t i = begin; i < count; ++i)
      to[i] += T(a[i]) * y[i] + T(b[i]) * y[count + i] + T(c[i]) * y[2 * count + i];
  }
}

// The same in packs, as far as a run has whole ones.
template <class T, int Bytes>
struct ForwardLoop {
  using P = Packs<T, Bytes>;
  using Pack = typename P::Pack;

  DF_INLINE static void run(const RowRun<const float>* rows, const T* const* x, T* y, std::size_t end) {
    const std::size_t count = rows->count, row = std::size_t(rows->slots) * count;
    for (std::size_t i = 0; i < end; i += P::size) {
      const float* a = rows->coefficient + i;
      Pack sum[3] = {}, from, own;
      for (int s = 0; s < rows->slots; ++s, a += count) {
        P::load(x[s] + i, from);
        P::load(a, own);
        sum[0] += own * from;
        P::load(a + row, own);
        sum[1] += own * from;
        P::load(a + 2 * row, own);
        sum[2] += own * from;
      }
      for (std::size_t c = 0; c < 3; ++c) P::store(sum[c], y + c * count + i);
    }
  }
};

template <class T, int Bytes>
struct BackwardLoop {
  using P = Packs<T, Bytes>;
  using Pack = typename P::Pack;

  DF_INLINE static void run(const RowRun<const float>* rows, const T* y, T* const* out, std::size_t end) {
    const std::size_t count = rows->count, row = std::size_t(rows->slots) * count;
    const float* a = rows->coefficient;
    for (int s = 0; s < rows->slots; ++s, a += count) {
      T* to = out[s];
      for (std::size_t i = 0; i < end; i += P::size) {
        Pack sum, own, moment;
        P::load(a + i, own);
        P::load(y + i, moment);
        sum = own * moment;
        P::load(a + row + i, own);
        P::load(y + count + i, moment);
        sum += own * moment;
        P::load(a + 2 * row + i, own);
        P::load(y + 2 * count + i, moment);
        sum += own * moment;
        P::load(to + i, own);
        P::store(own + sum, to + i);
      }
    }
  }
};

inline void forward(const RowRun<const float>& run, const float* const* x, float* y) {
  const std::size_t whole = run.count / lane_block * lane_block;
  if (whole > 0) run_loop<ForwardLoop, float>(&run, x, y, whole);
  forward<float>(run, x, y, whole);
}

inline void backward(const RowRun<const float>& run, const float* y, float* const* out) {
  const std::size_t whole = run.count / lane_block * lane_block;
  if (whole > 0) run_loop<BackwardLoop, float>(&run, y, out, whole);
  backward<float>(run, y, out, whole);
}

// The runs of x beside a run, by slot: pointers to the point i = 0's neighbours.
template <class T>
struct Beside {
  T* at[most_slots];
};

template <class T>
inline Beside<T> beside_edge(const EdgeRingLanes& ring, T* const* lane) {
  Beside<T> out;
  out.at[0] = lane[0] + 1;
  for (int j = 0; j < ring.size; ++j) out.at[j + 1] = lane[ring.lane[j]] + (1 + ring.at[j]);
  return out;
}

template <class T>
inline Beside<T> beside_row(bool quad, int n, int j, T* closed) {
  const auto at = [&](int i, int k) {
    return closed + closed_row(quad, std::size_t(n), std::size_t(k)) + std::size_t(i);
  };
  Beside<T> out;
  out.at[0] = at(1, j);
  int s = 1;
  for (const LatticePoint d : face_ring(quad)) out.at[s++] = at(1 + d.i, j + d.j);
  return out;
}

}  // namespace fairing
