// SPDX-License-Identifier: GPL-3.0-or-later
#include "energy/ring_passes.h"

namespace fairing {
namespace {

template <class T>
T back(const RowRun<const float>& run, int s, const T* moment) {
  return T(run.at(0, s, 0)) * moment[0] + T(run.at(1, s, 0)) * moment[1] + T(run.at(2, s, 0)) * moment[2];
}

// Three lanes from interleaved numbers.
template <class T>
void split(std::size_t count, const T* y, T* lanes) {
  for (std::size_t i = 0; i < count; ++i)
    for (std::size_t c = 0; c < 3; ++c) lanes[c * count + i] = y[3 * i + c];
}

// accumulate() with bodies for runs: on_vertex(v, run, moment); on_run(run, from the lattice's x, moment).
template <class T, class VertexMoment, class EdgeMoments, class FaceMoments>
void transpose(const RingRows& rows, const Unknowns& unknowns, Workers& workers, Exchange<T, 1>& exchange,
               T* out, VertexMoment&& vertex_moment, EdgeMoments&& edge_moments, FaceMoments&& face_moments) {
  const Lattice& lattice = rows.lattice();
  const ControlMesh& mesh = lattice.mesh();
  const int n = lattice.n();
  const auto vertex_body = [&](Index v, T* centre, T* spokes, std::vector<T>&) {
    const RowRun<const float> run = rows.vertex(v);
    T moment[3];
    vertex_moment(v, run, moment);
    *centre += back(run, 0, moment);
    int slot = 0;
    visit_ring(lattice, v, [&](Index, std::size_t place) { spokes[place] += back(run, ++slot, moment); });
  };
  const auto edge_body = [&](Index e, T* run, T* left, T* right, std::vector<T>& scratch) {
    clear_lanes<1>(n, run, left, right);
    if (n == 1) return;
    T* const target[3] = {run, left, right};
    const EdgeRingLanes ring(mesh, e);
    const RowRun<const float> own = rows.edge(e);
    const T* moments = edge_moments(e, ring, own, scratch);
    backward(own, moments, beside_edge(ring, target).at);
  };
  const auto face_body = [&](Index f, T* closed, std::vector<T>& scratch) {
    const bool quad = mesh.faces[std::size_t(f)].quad();
    std::fill_n(closed, closed_size(quad, std::size_t(n)), T(0));
    if (n < (quad ? 2 : 3)) return;
    face_moments(f, quad, scratch, [&](int j, const RowRun<const float>& run, const T* moments) {
      backward(run, moments, beside_row(quad, n, j, closed).at);
    });
  };
  accumulate(lattice, workers, exchange, &unknowns, out, vertex_body, edge_body, face_body);
}

}  // namespace

template <class T>
void apply_transposed(const RingRows& rows, const Unknowns& unknowns, Workers& workers,
                      Exchange<T, 1>& exchange, const T* y, T* out) {
  const Lattice& lattice = rows.lattice();
  const int n = lattice.n();
  const auto vertex_moment = [&](Index v, const RowRun<const float>&, T* moment) {
    copy_point(moment, y + 3 * std::size_t(v));
  };
  const auto edge_moments = [&](Index e, const EdgeRingLanes&, const RowRun<const float>& run,
                                std::vector<T>& scratch) -> const T* {
    scratch.resize(3 * std::size_t(n));
    split(run.count, y + 3 * std::size_t(lattice.edge_base(e)), scratch.data());
    return scratch.data();
  };
  const auto face_moments = [&](Index f, bool, std::vector<T>& scratch, auto&& put) {
    scratch.resize(3 * std::size_t(n));
    const T* from = y + 3 * std::size_t(lattice.face_base(f));
    for (int j = 1; j < n; ++j) {
      const RowRun<const float> run = rows.face(f, j);
      if (run.count == 0) break;
      split(run.count, from, scratch.data());
      put(j, run, scratch.data());
      from += 3 * run.count;
    }
  };
  transpose(rows, unknowns, workers, exchange, out, vertex_moment, edge_moments, face_moments);
}

template <class T>
void apply_square(const RingRows& rows, const Unknowns& unknowns, Workers& workers, Exchange<T, 1>& exchange,
                  const T* x, T* out) {
  const Lattice& lattice = rows.lattice();
  const int n = lattice.n();
  const auto vertex_moment = [&](Index v, const RowRun<const float>& run, T* moment) {
    for (int c = 0; c < 3; ++c) moment[c] = T(run.at(c, 0, 0)) * x[v];
    int slot = 0;
    visit_ring(lattice, v, [&](Index p, std::size_t) {
      ++slot;
      for (int c = 0; c < 3; ++c) moment[c] += T(run.at(c, slot, 0)) * x[p];
    });
  };
  const auto edge_moments = [&](Index e, const EdgeRingLanes& ring, const RowRun<const float>& run,
                                std::vector<T>& scratch) -> const T* {
    const std::size_t stride = lane_stride<1>(n) + lane_block;
    if (scratch.size() < 6 * stride) scratch.resize(6 * stride);
    const EdgeLanes<T, 1> lanes(lattice, x, e, scratch);
    T* moments = scratch.data() + 3 * stride;
    forward(run, beside_edge<T>(ring, lanes.lane).at, moments);
    return moments;
  };
  const auto face_moments = [&](Index f, bool quad, std::vector<T>& scratch, auto&& put) {
    const std::size_t size = closed_size(quad, std::size_t(n));
    T* const gathered = room_in(thread_scratch<T>().gathered, size);
    T* const moments = room_in(scratch, 3 * std::size_t(n));
    gather_face<1>(lattice, x, f, gathered);
    for (int j = 1; j < n; ++j) {
      const RowRun<const float> run = rows.face(f, j);
      if (run.count == 0) break;
      forward(run, beside_row(quad, n, j, gathered).at, moments);
      put(j, run, moments);
    }
  };
  transpose(rows, unknowns, workers, exchange, out, vertex_moment, edge_moments, face_moments);
}

void square_diagonal(const RingRows& rows, const Unknowns& unknowns, Workers& workers,
                     Exchange<float, 1>& exchange, const float* weight, float* out) {
  const Lattice& lattice = rows.lattice();
  const ControlMesh& mesh = lattice.mesh();
  const int n = lattice.n();
  const auto square = [&](const RowRun<const float>& run, int s, std::size_t i, std::size_t p) {
    float sum = 0;
    for (int c = 0; c < 3; ++c) sum += run.at(c, s, i) * run.at(c, s, i);
    return weight ? weight[p] * sum : sum;
  };
  const auto vertex_body = [&](Index v, float* centre, float* spokes, std::vector<float>&) {
    const RowRun<const float> run = rows.vertex(v);
    *centre += square(run, 0, 0, std::size_t(v));
    int slot = 0;
    visit_ring(lattice, v,
               [&](Index, std::size_t place) { spokes[place] += square(run, ++slot, 0, std::size_t(v)); });
  };
  const auto add_run = [&](const RowRun<const float>& run, const Beside<float>& target, std::size_t p) {
    for (int s = 0; s < run.slots; ++s)
      for (std::size_t i = 0; i < run.count; ++i) target.at[s][i] += square(run, s, i, p + i);
  };
  const auto edge_body = [&](Index e, float* run, float* left, float* right, std::vector<float>&) {
    clear_lanes<1>(n, run, left, right);
    if (n == 1) return;
    float* const lanes[3] = {run, left, right};
    add_run(rows.edge(e), beside_edge(EdgeRingLanes(mesh, e), lanes), std::size_t(lattice.edge_base(e)));
  };
  const auto face_body = [&](Index f, float* closed, std::vector<float>&) {
    const bool quad = mesh.faces[std::size_t(f)].quad();
    std::fill_n(closed, closed_size(quad, std::size_t(n)), 0.0f);
    std::size_t p = std::size_t(lattice.face_base(f));
    for (int j = 1; j < n; ++j) {
      const RowRun<const float> run = rows.face(f, j);
      if (run.count == 0) break;
      add_run(run, beside_row(quad, n, j, closed), p);
      p += run.count;
    }
  };
  accumulate(lattice, workers, exchange, &unknowns, out, vertex_body, edge_body, face_body);
}

#define DF_INSTANTIATE(T)                                                                                  \
  template void apply_transposed<T>(const RingRows&, const Unknowns&, Workers&, Exchange<T, 1>&, const T*, \
                                    T*);                                                                   \
  template void apply_square<T>(const RingRows&, const Unknowns&, Workers&, Exchange<T, 1>&, const T*, T*);
DF_INSTANTIATE(float)
DF_INSTANTIATE(double)
#undef DF_INSTANTIATE

}  // namespace fairing
