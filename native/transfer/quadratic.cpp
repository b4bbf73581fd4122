// SPDX-License-Identifier: GPL-3.0-or-later
#include "transfer/quadratic.h"

#include "grid/ring.h"

namespace fairing {
namespace {

// The share of the fit that is evaluated at the midpoint of a step inside a face.
constexpr double share_of(bool quad, GridPoint step) {
  return quad && step.i != 0 && step.j != 0 ? centre_share : midpoint_share;
}

// Linear values half-way to the ring of a vertex without a fit: visit(slot, weight, neighbours,
// count).
template <class T, class Visit>
void linear_halves(const ControlMesh& mesh, Index v, Visit&& visit) {
  const auto ring = mesh.ring(v);
  for (std::size_t k = 0; k < ring.size(); ++k) {
    const std::size_t along[1] = {2 * k};
    visit(2 * k, midpoint_share, T(0.5), along, std::size_t(1));
    if (ring[k].face < 0 || !mesh.faces[std::size_t(ring[k].face)].quad()) continue;
    const std::size_t cell[3] = {2 * k + 1, 2 * k, 2 * ((k + 1) % ring.size())};
    visit(2 * k + 1, centre_share, T(0.25), cell, std::size_t(3));
  }
}

}  // namespace

template <class T, int C>
void prolong(const GridLevel& coarse, const GridLevel& fine, const Stencils& st,
             const Unknowns* unknowns, Workers& workers, ElementSlots<T, C>& slots, const T* x,
             T* y) {
  const ControlMesh& mesh = coarse.mesh();
  const int n = coarse.n();

  const auto vertex_body = [&](Index v, T* centre, T* spokes, std::vector<T>& scratch) {
    const T* origin = x + C * std::size_t(v);
    copy_point<C>(centre, origin);
    scratch.assign(2 * C * mesh.ring(v).size(), T(0));
    visit_ring(coarse, v, [&](Index point, std::size_t slot) {
      for (std::size_t a = 0; a < C; ++a)
        scratch[C * slot + a] = x[C * std::size_t(point) + a] - origin[a];
    });
    if (!st.vertex_fit[std::size_t(v)]) {
      linear_halves<T>(mesh, v,
                       [&](std::size_t slot, double weight, T share, const std::size_t* from,
                           std::size_t count) {
                         for (std::size_t a = 0; a < C; ++a) {
                           T value = origin[a];
                           for (std::size_t m = 0; m < count; ++m)
                             value += share * scratch[C * from[m] + a];
                           spokes[C * slot + a] += T(weight) * value;
                         }
                       });
      return;
    }
    const auto first = 5 * std::size_t(st.ring_offset[std::size_t(v)]);
    T c[5][C] = {};
    const float* row = st.vertex_rows.data() + first;
    visit_ring(coarse, v, [&](Index, std::size_t slot) {
      for (std::size_t m = 0; m < 5; ++m)
        for (std::size_t a = 0; a < C; ++a) c[m][a] += T(row[m]) * scratch[C * slot + a];
      row += 5;
    });
    const float* half = st.vertex_half.data() + first;
    visit_ring(coarse, v, [&](Index, std::size_t slot) {
      const T weight = T(slot % 2 == 0 ? midpoint_share : centre_share);
      for (std::size_t a = 0; a < C; ++a) {
        T value = origin[a];
        for (std::size_t m = 0; m < 5; ++m) value += T(half[m]) * c[m][a];
        spokes[C * slot + a] += weight * value;
      }
      half += 5;
    });
  };

  const auto edge_body = [&](Index e, T* run, T* left, T* right, std::vector<T>& scratch) {
    clear_lanes<C>(2 * n, run, left, right);
    if (n == 1) return;
    const EdgeRingLanes ring(mesh, e);
    const EdgeLanes<T, C> lanes(coarse, x, e, scratch);
    T* const target[3] = {run, left, right};
    const float* half = st.edge_half.data() + 64 * std::size_t(e);
    for (int k = 1; k < n; ++k) {
      const T* origin = lanes.lane[0] + C * k;
      copy_point<C>(run + 2 * C * k, origin);
      T d[8][C];
      for (int j = 0; j < ring.size; ++j)
        for (int a = 0; a < C; ++a)
          d[j][a] = lanes.lane[ring.lane[j]][C * (ring.at[j] + k) + a] - origin[a];
      for (int j = 0; j < ring.size; ++j) {
        T* to = target[ring.lane[j]] + C * (2 * k + ring.at[j]);
        const T weight = T(ring.far[j] ? centre_share : midpoint_share);
        for (int a = 0; a < C; ++a) {
          T value = origin[a];
          for (int m = 0; m < ring.size; ++m) value += T(half[8 * j + m]) * d[m][a];
          to[a] += weight * value;
        }
      }
    }
  };

  const auto face_body = [&](Index f, T* closed, std::vector<T>&) {
    const bool quad = mesh.faces[std::size_t(f)].quad();
    std::fill(closed, closed + C * closed_size(quad, 2 * std::size_t(n)), T(0));
    if (n < (quad ? 2 : 3)) return;
    T* const gathered =
        room_in(thread_scratch<T>().gathered, C * closed_size(true, std::size_t(n)));
    gather_face<C>(coarse, x, f, gathered);
    const auto from = [&](int i, int j) {
      return gathered + C * (closed_row(quad, std::size_t(n), std::size_t(j)) + std::size_t(i));
    };
    const auto to = [&](int i, int j) {
      return closed + C * (closed_row(quad, std::size_t(2 * n), std::size_t(j)) + std::size_t(i));
    };
    for (int j = 1; j < n; ++j) {
      const int width = quad ? n - 1 : n - 1 - j;
      for (int i = 1; i <= width; ++i) add_point<C>(to(2 * i, 2 * j), from(i, j));
      for (const GridPoint d : face_ring(quad)) {
        const double share = share_of(quad, d);
        const T wa = T(share * MidpointWeights::ahead), wh = T(share * MidpointWeights::here),
                wb = T(share * MidpointWeights::behind);
        const T *p = from(1, j), *q = from(1 + d.i, j + d.j), *r = from(1 - d.i, j - d.j);
        T* out = to(2 + d.i, 2 * j + d.j);
        for (int i = 0; i < width; ++i)
          for (int a = 0; a < C; ++a)
            out[2 * C * i + a] += wa * q[C * i + a] + wh * p[C * i + a] + wb * r[C * i + a];
      }
    }
  };

  accumulate(fine, workers, slots, unknowns, y, vertex_body, edge_body, face_body);
}

template <class T, int C>
void restrict_to(const GridLevel& coarse, const GridLevel& fine, const Stencils& st,
                 const Unknowns& unknowns, Workers& workers, ElementSlots<T, C>& slots, const T* x,
                 T* y) {
  const ControlMesh& mesh = coarse.mesh();
  const int n = coarse.n();

  const auto vertex_body = [&](Index v, T* centre, T* spokes, std::vector<T>& scratch) {
    add_point<C>(centre, x + C * std::size_t(v));
    scratch.assign(2 * C * mesh.ring(v).size(), T(0));
    visit_ring(fine, v, [&](Index point, std::size_t slot) {
      copy_point<C>(&scratch[C * slot], x + C * std::size_t(point));
    });
    // Contributions to a neighbour's difference are subtracted at the centre.
    const auto add_to_difference = [&](std::size_t slot, const T* z) {
      for (std::size_t a = 0; a < C; ++a) {
        spokes[C * slot + a] += z[a];
        centre[a] -= z[a];
      }
    };
    if (!st.vertex_fit[std::size_t(v)]) {
      linear_halves<T>(mesh, v,
                       [&](std::size_t slot, double weight, T share, const std::size_t* from,
                           std::size_t count) {
                         T z[C];
                         for (std::size_t a = 0; a < C; ++a) {
                           const T w = T(weight) * scratch[C * slot + a];
                           centre[a] += w;
                           z[a] = share * w;
                         }
                         for (std::size_t m = 0; m < count; ++m) add_to_difference(from[m], z);
                       });
      return;
    }
    const auto first = 5 * std::size_t(st.ring_offset[std::size_t(v)]);
    T c[5][C] = {};
    const float* half = st.vertex_half.data() + first;
    visit_ring(coarse, v, [&](Index, std::size_t slot) {
      const T weight = T(slot % 2 == 0 ? midpoint_share : centre_share);
      for (std::size_t a = 0; a < C; ++a) {
        const T w = weight * scratch[C * slot + a];
        centre[a] += w;
        for (std::size_t m = 0; m < 5; ++m) c[m][a] += T(half[m]) * w;
      }
      half += 5;
    });
    const float* row = st.vertex_rows.data() + first;
    visit_ring(coarse, v, [&](Index, std::size_t slot) {
      T z[C] = {};
      for (std::size_t a = 0; a < C; ++a)
        for (std::size_t m = 0; m < 5; ++m) z[a] += T(row[m]) * c[m][a];
      add_to_difference(slot, z);
      row += 5;
    });
  };

  const auto edge_body = [&](Index e, T* run, T* left, T* right, std::vector<T>& scratch) {
    clear_lanes<C>(n, run, left, right);
    if (n == 1) return;
    const EdgeRingLanes ring(mesh, e);
    const EdgeLanes<T, C> lanes(fine, x, e, scratch);
    T* const target[3] = {run, left, right};
    const float* half = st.edge_half.data() + 64 * std::size_t(e);
    for (int k = 1; k < n; ++k) {
      T* own = run + C * k;
      add_point<C>(own, lanes.lane[0] + 2 * C * k);
      T w[8][C];
      for (int j = 0; j < ring.size; ++j) {
        const T weight = T(ring.far[j] ? centre_share : midpoint_share);
        for (int a = 0; a < C; ++a) {
          w[j][a] = weight * lanes.lane[ring.lane[j]][C * (2 * k + ring.at[j]) + a];
          own[a] += w[j][a];
        }
      }
      for (int m = 0; m < ring.size; ++m) {
        T* to = target[ring.lane[m]] + C * (ring.at[m] + k);
        for (int a = 0; a < C; ++a) {
          T z = 0;
          for (int j = 0; j < ring.size; ++j) z += T(half[8 * j + m]) * w[j][a];
          to[a] += z;
          own[a] -= z;
        }
      }
    }
  };

  const auto face_body = [&](Index f, T* closed, std::vector<T>&) {
    const bool quad = mesh.faces[std::size_t(f)].quad();
    std::fill(closed, closed + C * closed_size(quad, std::size_t(n)), T(0));
    if (n < (quad ? 2 : 3)) return;
    T* const gathered =
        room_in(thread_scratch<T>().gathered, C * closed_size(true, std::size_t(2 * n)));
    gather_face<C>(fine, x, f, gathered);
    const auto from = [&](int i, int j) {
      return gathered + C * (closed_row(quad, std::size_t(2 * n), std::size_t(j)) + std::size_t(i));
    };
    const auto to = [&](int i, int j) {
      return closed + C * (closed_row(quad, std::size_t(n), std::size_t(j)) + std::size_t(i));
    };
    for (int j = 1; j < n; ++j) {
      const int width = quad ? n - 1 : n - 1 - j;
      for (int i = 1; i <= width; ++i) add_point<C>(to(i, j), from(2 * i, 2 * j));
      for (const GridPoint d : face_ring(quad)) {
        const double share = share_of(quad, d);
        const T wa = T(share * MidpointWeights::ahead), wh = T(share * MidpointWeights::here),
                wb = T(share * MidpointWeights::behind);
        T *p = to(1, j), *q = to(1 + d.i, j + d.j), *r = to(1 - d.i, j - d.j);
        const T* in = from(2 + d.i, 2 * j + d.j);
        for (int i = 0; i < width; ++i)
          for (int a = 0; a < C; ++a) {
            const T w = in[2 * C * i + a];
            q[C * i + a] += wa * w;
            p[C * i + a] += wh * w;
            r[C * i + a] += wb * w;
          }
      }
    }
  };

  accumulate(coarse, workers, slots, &unknowns, y, vertex_body, edge_body, face_body);
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
