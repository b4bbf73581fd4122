// SPDX-License-Identifier: GPL-3.0-or-later
// Tension's part of K on one level: (L x)_i = sum_j w_ij (x_i - x_j) over the ring of i, with the
// weights of stencil/membrane.h. They are the same from both ends of an edge, so each point's row
// is gathered from its own ring.
#pragma once

#include "base/simd.h"
#include "grid/accumulate.h"
#include "stencil/stencils.h"

namespace fairing {

namespace passes {

template <class T, int Bytes>
struct MembranePass {
  using P = Packs<T, Bytes>;
  using Pack = typename P::Pack;

  DF_INLINE static void run(std::ptrdiff_t numbers, int size, const T* weight, const T* const* at,
                            T* out) {
    std::ptrdiff_t i = 0;
    for (; i + P::size <= numbers; i += P::size) {
      Pack own, other, sum = {};
      P::load(at[0] + i, own);
      for (int s = 0; s < size; ++s) {
        P::load(at[1 + s] + i, other);
        sum += weight[s] * (own - other);
      }
      P::load(out + i, other);
      P::store(other + sum, out + i);
    }
    for (; i < numbers; ++i) {
      T sum = 0;
      for (int s = 0; s < size; ++s) sum += weight[s] * (at[0][i] - at[1 + s][i]);
      out[i] += sum;
    }
  }
};

}  // namespace passes

// Adds L x on a level's unknowns to the values that accumulate() sets. Does nothing without
// tension.
template <class T>
class MembraneRows {
 public:
  MembraneRows(const GridLevel& grid, const Stencils& stencils, const Unknowns& unknowns,
               const T* x)
      : grid_(grid), stencils_(stencils), unknowns_(unknowns), x_(x) {}

  bool any() const { return stencils_.membrane.any(); }

  void add_vertex(Index v, T* centre) const {
    if (!any() || !unknowns_.vertex[std::size_t(v)]) return;
    const double* weight = stencils_.membrane.vertex.data() + stencils_.ring_offset[std::size_t(v)];
    const T* own = x_ + 3 * std::size_t(v);
    visit_ring(grid_, v, [&](Index point, std::size_t) {
      for (std::size_t a = 0; a < 3; ++a)
        centre[a] += T(*weight) * (own[a] - x_[3 * std::size_t(point) + a]);
      ++weight;
    });
  }
  // `lane`: those of EdgeLanes; `run`: points 0 … n of the edge.
  void add_edge(Index e, const EdgeRingLanes& ring, const T* const* lane, T* run) const {
    if (!any() || !unknowns_.edge[std::size_t(e)]) return;
    RunNeighbours<const T> beside;
    set_beside_edge<const T, 3>(ring, lane, beside);
    add(stencils_.membrane.edge.data() + 8 * std::size_t(e), ring.size, ring.size, grid_.n() - 1,
        beside.at, run + 3);
  }
  // `gathered`: x on the closed face.
  void add_face(Index f, const T* gathered, T* closed) const {
    if (!any()) return;
    const bool quad = grid_.mesh().faces[std::size_t(f)].quad();
    const int n = grid_.n(), directions = quad ? 4 : 3;
    const double* weight = stencils_.membrane.face.data() + 4 * std::size_t(f);
    RunNeighbours<const T> beside;
    for (int j = 1; j <= (quad ? n - 1 : n - 2); ++j) {
      set_beside_row<const T, 3>(quad, n, j, gathered, beside);
      add(weight, directions, 2 * directions, int(row_count(quad, n, j)), beside.at,
          closed + 3 * (closed_row(quad, std::size_t(n), std::size_t(j)) + 1));
    }
  }

 private:
  static void add(const double* weight, int period, int size, int points, const T* const* at,
                  T* out) {
    T w[8];
    for (int s = 0; s < size; ++s) w[s] = T(weight[s % period]);
    run_loop<passes::MembranePass, T>(3 * std::ptrdiff_t(points), size, static_cast<const T*>(w),
                                      at, out);
  }

  const GridLevel& grid_;
  const Stencils& stencils_;
  const Unknowns& unknowns_;
  const T* x_;
};

// x . L x over all points.
double membrane_energy(const GridLevel& grid, const Stencils& stencils, Workers& workers,
                       const double* x);

}  // namespace fairing
