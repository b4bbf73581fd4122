// SPDX-License-Identifier: GPL-3.0-or-later
#include "transfer/quadratic.h"

#include "grid/ring_shape.h"

namespace fairing {
namespace {

// The fine points half-way from the points of a coarse run to their neighbours, in lanes of the
// fine level: those of slot s of point i are at (*this)[s] + 2 C i.
template <class T, int C>
class Halfway {
 public:
  // at(slot): the slots of visit_ring.
  template <class At>
  void set_vertex(const GridLevel& grid, Index v, T* own, At&& at) {
    spokes_.start(own);
    visit_ring(grid, v, [&](Index, std::size_t slot) { spokes_.add(at(slot)); });
    at_ = spokes_.list();
  }
  void set_edge(const EdgeRingLanes& ring, T* const* lane) {
    beside_.at[0] = lane[0] + 2 * C;
    for (int j = 0; j < ring.size; ++j)
      beside_.at[j + 1] = lane[ring.lane[j]] + C * (2 + ring.at[j]);
    at_ = beside_.at;
  }
  // For a row of a coarse face of n pieces, in the closed fine face.
  void set_row(int n, const Run& run, T* closed) {
    const auto at = [&](GridPoint d) {
      const auto row = std::size_t(2 * run.row + d.j);
      return closed + C * (closed_row(run.quad, 2 * std::size_t(n), row) + std::size_t(2 + d.i));
    };
    beside_.at[0] = at({0, 0});
    int s = 1;
    for (const GridPoint d : face_ring(run.quad)) beside_.at[s++] = at(d);
    at_ = beside_.at;
  }
  T* operator[](std::size_t s) const { return at_[s]; }

 private:
  T* const* at_ = nullptr;
  RunNeighbours<T> beside_;
  SpokePointers<T> spokes_;
};

// The rows of a run's points for the values half-way to their neighbours.
template <class T, int C>
class RunFit {
 public:
  RunFit(const GridLevel& coarse, const Stencils& stencils)
      : coarse_(coarse), stencils_(stencils) {}

  // to[s] += the share of the value half-way to neighbour s, from the coarse points at from[s].
  void prolong(const Run& run, const T* const* from, const Halfway<T, C>& to) {
    read(run);
    for (std::size_t i = 0; i < run.count; ++i) add_point<C>(to[0] + 2 * C * i, from[0] + C * i);
    for (std::size_t s = 1; s <= size_ && in_face(run); ++s) {
      const Parabola w(share(s));
      const T *p = from[0], *q = from[s], *r = from[opposite(s)];
      T* out = to[s];
      for (std::size_t i = 0; i < run.count; ++i)
        for (std::size_t a = 0; a < C; ++a)
          out[2 * C * i + a] +=
              w.ahead * q[C * i + a] + w.here * p[C * i + a] + w.behind * r[C * i + a];
    }
    for (std::size_t i = 0; i < run.count && !in_face(run); ++i) prolong_point(i, from, to);
  }

  // The transpose.
  void restrict_to(const Run& run, const Halfway<const T, C>& from, T* const* to) {
    read(run);
    for (std::size_t i = 0; i < run.count; ++i) add_point<C>(to[0] + C * i, from[0] + 2 * C * i);
    for (std::size_t s = 1; s <= size_ && in_face(run); ++s) {
      const Parabola w(share(s));
      T *p = to[0], *q = to[s], *r = to[opposite(s)];
      const T* in = from[s];
      for (std::size_t i = 0; i < run.count; ++i)
        for (std::size_t a = 0; a < C; ++a) {
          const T own = in[2 * C * i + a];
          q[C * i + a] += w.ahead * own;
          p[C * i + a] += w.here * own;
          r[C * i + a] += w.behind * own;
        }
    }
    for (std::size_t i = 0; i < run.count && !in_face(run); ++i) restrict_point(i, from, to);
  }

 private:
  struct Parabola {
    explicit Parabola(T share)
        : ahead(share * T(MidpointWeights::ahead)),
          here(share * T(MidpointWeights::here)),
          behind(share * T(MidpointWeights::behind)) {}
    T ahead, here, behind;
  };
  static bool in_face(const Run& run) { return run.kind == RunKind::face_row; }

  void read(const Run& run) {
    if (run.row > 1) return;
    shape_.set(coarse_, run);
    size_ = shape_.far.size();
    if (in_face(run)) return;
    const auto element = std::size_t(element_of(coarse_.mesh(), run));
    has_fit_ = stencils_.has_fit[element];
    rows_ = stencils_.rows.data() + 5 * stencils_.begin[element];
    half_ = stencils_.half.data() + 5 * stencils_.begin[element];
    difference_.resize(C * size_);
  }
  bool is_far(std::size_t s) const { return shape_.far[s - 1] != 0; }
  // Weight of a fit's value there.
  T share(std::size_t s) const { return T(is_far(s) ? centre_share : midpoint_share); }
  std::size_t opposite(std::size_t s) const { return (s - 1 + size_ / 2) % size_ + 1; }

  // Without a fit, calls visit(neighbour) for those that share the linear value half-way to s;
  // across a quad it is the mean of the cell's corners.
  template <class Visit>
  T visit_linear(std::size_t s, Visit&& visit) const {
    visit(s);
    if (!is_far(s)) return T(0.5);
    visit((s - 2 + size_) % size_ + 1);
    visit(s % size_ + 1);
    return T(0.25);
  }

  void prolong_point(std::size_t i, const T* const* from, const Halfway<T, C>& to) {
    const T* origin = from[0] + C * i;
    T c[5][C] = {};
    for (std::size_t s = 1; s <= size_; ++s)
      for (std::size_t a = 0; a < C; ++a) {
        const T d = difference_[C * (s - 1) + a] = from[s][C * i + a] - origin[a];
        for (std::size_t m = 0; m < 5; ++m) c[m][a] += T(rows_[5 * (s - 1) + m]) * d;
      }
    for (std::size_t s = 1; s <= size_; ++s) {
      T value[C] = {};
      if (has_fit_) {
        for (std::size_t m = 0; m < 5; ++m)
          for (std::size_t a = 0; a < C; ++a) value[a] += T(half_[5 * (s - 1) + m]) * c[m][a];
      } else {
        const T each =
            visit_linear(s, [&](std::size_t q) { add_point<C>(value, &difference_[C * (q - 1)]); });
        for (T& number : value) number *= each;
      }
      for (std::size_t a = 0; a < C; ++a) to[s][2 * C * i + a] += share(s) * (origin[a] + value[a]);
    }
  }

  void restrict_point(std::size_t i, const Halfway<const T, C>& from, T* const* to) {
    T c[5][C] = {}, own[C] = {};
    std::fill(difference_.begin(), difference_.end(), T(0));
    for (std::size_t s = 1; s <= size_; ++s) {
      T value[C];
      for (std::size_t a = 0; a < C; ++a) {
        value[a] = share(s) * from[s][2 * C * i + a];
        own[a] += value[a];
        for (std::size_t m = 0; m < 5; ++m) c[m][a] += T(half_[5 * (s - 1) + m]) * value[a];
      }
      if (has_fit_) continue;
      for (T& number : value) number *= T(is_far(s) ? 0.25 : 0.5);
      visit_linear(s, [&](std::size_t q) { add_point<C>(&difference_[C * (q - 1)], value); });
    }
    for (std::size_t s = 1; s <= size_; ++s)
      for (std::size_t a = 0; a < C; ++a) {
        T z = difference_[C * (s - 1) + a];
        for (std::size_t m = 0; m < 5; ++m) z += T(rows_[5 * (s - 1) + m]) * c[m][a];
        to[s][C * i + a] += z;
        own[a] -= z;
      }
    add_point<C>(to[0] + C * i, own);
  }

  const GridLevel& coarse_;
  const Stencils& stencils_;
  RingShape shape_;
  std::size_t size_ = 0;
  bool has_fit_ = false;
  const float *rows_ = nullptr, *half_ = nullptr;
  std::vector<T> difference_;  // by neighbour
};

}  // namespace

template <class T, int C>
void prolong(const GridLevel& coarse, const GridLevel& fine, const Stencils& st,
             const Unknowns* unknowns, Workers& workers, ElementSlots<T, C>& slots, const T* x,
             T* y) {
  struct State {
    RunGather<T, C> from;
    RunFit<T, C> fit;
    Halfway<T, C> to{};
  };
  const int n = coarse.n();
  accumulate(
      fine, workers, slots, unknowns, y, [&] { return State{{coarse, x}, {coarse, st}}; },
      [&](Index v, T* centre, T* spokes, State& s) {
        s.to.set_vertex(coarse, v, centre, [&](std::size_t slot) { return spokes + C * slot; });
        s.fit.prolong(vertex_run(v), s.from(vertex_run(v)), s.to);
      },
      [&](Index e, T* run, T* left, T* right, State& s) {
        clear_lanes<C>(2 * n, run, left, right);
        T* const lane[3] = {run, left, right};
        for_edge_run(coarse, e, [&](const Run& edge) {
          s.to.set_edge(*edge.ring, lane);
          s.fit.prolong(edge, s.from(edge), s.to);
        });
      },
      [&](Index f, T* closed, State& s) {
        const bool quad = coarse.mesh().faces[f].quad();
        std::fill_n(closed, C * closed_size(quad, 2 * std::size_t(n)), T(0));
        for_face_runs(coarse, f, [&](const Run& row) {
          s.to.set_row(n, row, closed);
          s.fit.prolong(row, s.from(row), s.to);
        });
      });
}

template <class T, int C>
void restrict_to(const GridLevel& coarse, const GridLevel& fine, const Stencils& st,
                 const Unknowns& unknowns, Workers& workers, ElementSlots<T, C>& slots, const T* x,
                 T* y) {
  struct State {
    RunFit<T, C> fit;
    std::vector<T>& buffer = thread_scratch<T>().gathered;
    Halfway<const T, C> from{};
  };
  const int n = coarse.n();
  accumulate_runs(
      coarse, workers, slots, &unknowns, y, [&] { return State{{coarse, st}}; },
      [&](const Run& run, T* const* target, State& s) {
        if (run.kind == RunKind::vertex) {
          const T* const own = x + C * run.first;
          const auto ring = fine.mesh().ring(run.element);
          s.from.set_vertex(coarse, run.element, own, [&](std::size_t slot) {
            const Spoke& spoke = ring[slot / 2];
            const Index p = slot % 2 == 0 ? fine.spoke_point(spoke) : fine.diagonal_point(spoke);
            return x + C * std::size_t(p);
          });
        } else if (run.kind == RunKind::edge) {
          const EdgeLanes<T, C> lanes(fine, x, run.element, s.buffer);
          const T* const lane[3] = {lanes.lane[0], lanes.lane[1], lanes.lane[2]};
          s.from.set_edge(*run.ring, lane);
        } else {
          if (run.row == 1)
            gather_face<C>(fine, x, run.element,
                           room_in(s.buffer, C * closed_size(run.quad, std::size_t(2 * n))));
          s.from.set_row(n, run, s.buffer.data());
        }
        s.fit.restrict_to(run, s.from, target);
      });
}

#define DF_INSTANTIATE(T, C)                                                                 \
  template void prolong<T, C>(const GridLevel&, const GridLevel&, const Stencils&,           \
                              const Unknowns*, Workers&, ElementSlots<T, C>&, const T*, T*); \
  template void restrict_to<T, C>(const GridLevel&, const GridLevel&, const Stencils&,       \
                                  const Unknowns&, Workers&, ElementSlots<T, C>&, const T*, T*);
DF_INSTANTIATE(float, 1)
DF_INSTANTIATE(float, 3)
DF_INSTANTIATE(double, 3)
#undef DF_INSTANTIATE

}  // namespace fairing
