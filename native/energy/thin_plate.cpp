// SPDX-License-Identifier: GPL-3.0-or-later
#include "energy/thin_plate.h"

#include "energy/edge_pass.h"
#include "energy/face_passes.h"
#include "energy/joint_weight.h"
#include "execution/cancel.h"
#include "lattice/ring.h"

namespace fairing {
namespace {

// y = rows (x_ring - x_0): 3 rows by 3 coordinates.
template <class T>
struct Moment {
  T y[3][3] = {};
  void add(const T* row, std::size_t stride, const T* difference) {
    for (std::size_t c = 0; c < 3; ++c)
      for (std::size_t a = 0; a < 3; ++a) y[c][a] += row[c * stride] * difference[a];
  }
  // The transposed row's part for one neighbour.
  void transposed(const T* row, std::size_t stride, T* z) const {
    for (std::size_t a = 0; a < 3; ++a)
      z[a] = row[0] * y[0][a] + row[stride] * y[1][a] + row[2 * stride] * y[2][a];
  }
  double square() const {
    double sum = 0;
    for (const auto& r : y)
      for (const T v : r) sum += double(v) * double(v);
    return sum;
  }
};

template <class T>
void difference(const T* p, const T* origin, T* d) {
  for (std::size_t a = 0; a < 3; ++a) d[a] = p[a] - origin[a];
}

template <class T>
Moment<T> vertex_moment(const Lattice& lattice, const ThinPlateRows<T>& rows, Index v, const T* x) {
  Moment<T> moment;
  const T* row = rows.vertex.data() + 3 * std::size_t(rows.stencils.ring_offset[std::size_t(v)]);
  visit_ring(lattice, v, [&](Index point, std::size_t) {
    T d[3];
    difference(x + 3 * std::size_t(point), x + 3 * std::size_t(v), d);
    moment.add(row, 1, d);
    row += 3;
  });
  return moment;
}

template <class T>
Moment<T> edge_moment(const EdgeRingLanes& ring, const EdgeLanes<T>& lanes, const T* row, int k) {
  Moment<T> moment;
  for (int j = 0; j < ring.size; ++j) {
    T d[3];
    difference(lanes.lane[ring.lane[j]] + 3 * (ring.at[j] + k), lanes.lane[0] + 3 * k, d);
    moment.add(row + j, 8, d);
  }
  return moment;
}

template <class T>
void edge_weights(const JointWeight& joint, int n, Index e, T* weight) {
  for (int k = 1; k < n; ++k) *weight++ = T(joint.edge_point(e, k));
}

// Three equal numbers a point of the closed face.
template <class T>
void face_weights(const JointWeight& joint, bool quad, int n, Index f, T* weight) {
  for (int j = 0; j <= n; ++j)
    for (int i = 0; i <= (quad ? n : n - j); ++i, weight += 3)
      std::fill(weight, weight + 3, T(joint.face_point(f, i, j)));
}

}  // namespace

template <class T>
ThinPlateRows<T>::ThinPlateRows(const ControlMesh& mesh, const Stencils& s) : stencils(s) {
  vertex.resize(s.vertex_energy.size());
  copy_long(s.vertex_energy.data(), vertex.size(), vertex.data());
  edge.resize(s.edge_energy.size());
  copy_long(s.edge_energy.data(), edge.size(), edge.data());
  face.resize(16 * mesh.faces.size());
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    stop_if_cancelled(f);
    const double* g = s.face_energy.data() + 12 * f;
    for (std::size_t a = 0; a < 4; ++a)
      for (std::size_t b = 0; b < 4; ++b)
        face[16 * f + 4 * a + b] = T(g[a] * g[b] + g[4 + a] * g[4 + b] + g[8 + a] * g[8 + b]);
  }
}

template struct ThinPlateRows<float>;
template struct ThinPlateRows<double>;

template <class T>
void apply_thin_plate(const Lattice& lattice, const ThinPlateRows<T>& rows, const Unknowns& unknowns,
                      const VertexWeights& weights, Workers& workers, Exchange<T>& exchange, const T* x,
                      T* y) {
  const ControlMesh& mesh = lattice.mesh();
  const int n = lattice.n();
  const T level_scale = T(n) * T(n);
  const JointWeight joint(lattice);

  const auto vertex_body = [&](Index v, T* centre, T* spokes, std::vector<T>&) {
    if (rows.stencils.vertex_fit[std::size_t(v)]) {
      const T scale = level_scale * T(joint.vertex(v));
      const Moment<T> moment = vertex_moment(lattice, rows, v, x);
      const T* row = rows.vertex.data() + 3 * std::size_t(rows.stencils.ring_offset[std::size_t(v)]);
      visit_ring(lattice, v, [&](Index, std::size_t slot) {
        T z[3];
        moment.transposed(row, 1, z);
        row += 3;
        for (std::size_t a = 0; a < 3; ++a) {
          spokes[3 * slot + a] += scale * z[a];
          centre[a] -= scale * z[a];
        }
      });
    }
    if (!weights.empty())
      for (std::size_t a = 0; a < 3; ++a) centre[a] += T(weights[std::size_t(v)]) * x[3 * std::size_t(v) + a];
  };

  const auto edge_body = [&](Index e, T* run, T* left, T* right, std::vector<T>& scratch) {
    if (n == 1 || !rows.stencils.edge_fit[std::size_t(e)]) {
      clear_lanes(n, run, left, right);
      return;
    }
    const std::size_t stride = lane_stride(n) + lane_block;
    if (scratch.size() < 9 * stride) scratch.resize(9 * stride);
    const EdgeRingLanes ring(mesh, e);
    const EdgeLanes<T> lanes(lattice, x, e, scratch);
    T* const target[3] = {run, left, right};
    T* weight = joint.weighs_edge(e) ? scratch.data() + 8 * stride : nullptr;
    if (weight) edge_weights(joint, n, e, weight);
    set_edge_pass(n, ring, rows.edge.data() + 24 * std::size_t(e), level_scale, lanes.lane, weight, target,
                  scratch.data() + 3 * stride);
  };

  const auto face_body = [&](Index f, T* closed, std::vector<T>& scratch) {
    const bool quad = mesh.faces[std::size_t(f)].quad();
    const std::size_t size = 3 * closed_size(quad, std::size_t(n)) + lane_block;
    const std::size_t moments = passes::moments_size(n);
    if (n < (quad ? 2 : 3)) {
      std::fill(closed, closed + 3 * closed_size(quad, std::size_t(n)), T(0));
      return;
    }
    const bool weighted = joint.weighs_face(f);
    if (scratch.size() < moments) scratch.resize(moments);
    T* gathered = room_in(thread_scratch<T>().gathered, (weighted ? 2 : 1) * size);
    gather_face(lattice, x, f, gathered);
    T* weight = weighted ? gathered + size : nullptr;
    if (weight) face_weights(joint, quad, n, f, weight);
    const T* c = rows.face.data() + 16 * std::size_t(f);
    if (quad)
      set_quad_pass(n, c, level_scale, gathered, weight, closed, scratch.data());
    else
      set_triangle_pass(n, c, level_scale, gathered, weight, closed, scratch.data());
  };

  accumulate(lattice, workers, exchange, &unknowns, y, vertex_body, edge_body, face_body);
}

template void apply_thin_plate<float>(const Lattice&, const ThinPlateRows<float>&, const Unknowns&,
                                      const VertexWeights&, Workers&, Exchange<float>&, const float*, float*);
template void apply_thin_plate<double>(const Lattice&, const ThinPlateRows<double>&, const Unknowns&,
                                       const VertexWeights&, Workers&, Exchange<double>&, const double*,
                                       double*);

Array<float> thin_plate_diagonal(const Lattice& lattice, const ThinPlateRows<double>& rows,
                                 const Unknowns& unknowns, const VertexWeights& weights, Workers& workers,
                                 Exchange<double>& exchange) {
  const ControlMesh& mesh = lattice.mesh();
  const int n = lattice.n();
  const double level_scale = double(n) * double(n);
  const JointWeight joint(lattice);
  // The same sums as K's, of the squared coefficients; all three coordinates carry the same number.
  const auto put = [&](double* target, double weight, double square) {
    for (std::size_t a = 0; a < 3; ++a) target[a] += level_scale * weight * square;
  };
  const auto square = [](const double* row, std::size_t stride) {
    return row[0] * row[0] + row[stride] * row[stride] + row[2 * stride] * row[2 * stride];
  };

  const auto vertex_body = [&](Index v, double* centre, double* spokes, std::vector<double>&) {
    if (!weights.empty())
      for (std::size_t a = 0; a < 3; ++a) centre[a] += weights[std::size_t(v)];
    if (!rows.stencils.vertex_fit[std::size_t(v)]) return;
    const double* row = rows.vertex.data() + 3 * std::size_t(rows.stencils.ring_offset[std::size_t(v)]);
    double total[3] = {};
    const double weight = joint.vertex(v);
    visit_ring(lattice, v, [&](Index, std::size_t slot) {
      put(spokes + 3 * slot, weight, square(row, 1));
      for (std::size_t c = 0; c < 3; ++c) total[c] += row[c];
      row += 3;
    });
    put(centre, weight, square(total, 1));
  };

  const auto edge_body = [&](Index e, double* run, double* left, double* right, std::vector<double>&) {
    clear_lanes(n, run, left, right);
    if (n == 1 || !rows.stencils.edge_fit[std::size_t(e)]) return;
    const EdgeRingLanes ring(mesh, e);
    double* const target[3] = {run, left, right};
    const double* row = rows.edge.data() + 24 * std::size_t(e);
    double total[3] = {};
    for (int j = 0; j < ring.size; ++j)
      for (std::size_t c = 0; c < 3; ++c) total[c] += row[8 * c + std::size_t(j)];
    for (int k = 1; k < n; ++k) {
      const double weight = joint.edge_point(e, k);
      for (int j = 0; j < ring.size; ++j)
        put(target[ring.lane[j]] + 3 * (ring.at[j] + k), weight, square(row + j, 8));
      put(run + 3 * k, weight, square(total, 1));
    }
  };

  const auto face_body = [&](Index f, double* closed, std::vector<double>&) {
    const bool quad = mesh.faces[std::size_t(f)].quad();
    std::fill(closed, closed + 3 * closed_size(quad, std::size_t(n)), 0.0);
    const double* c = rows.face.data() + 16 * std::size_t(f);
    const int directions = quad ? 4 : 3;
    const bool weighted = joint.weighs_face(f);
    double all = 0;
    for (int a = 0; a < directions; ++a)
      for (int b = 0; b < directions; ++b) all += c[4 * a + b];
    const LatticePoint step[2][4] = {{{1, 0}, {0, 1}, {-1, 1}, {0, 0}}, {{1, 0}, {1, 1}, {0, 1}, {-1, 1}}};
    const auto at = [&](int i, int j) {
      return closed + 3 * (closed_row(quad, std::size_t(n), std::size_t(j)) + std::size_t(i));
    };
    for (int j = 1; j < n; ++j)
      for (int i = 1; i < (quad ? n : n - j); ++i) {
        const double weight = weighted ? joint.face_point(f, i, j) : 1.0;
        put(at(i, j), weight, 4 * all);
        for (int a = 0; a < directions; ++a) {
          const LatticePoint d = step[quad][a];
          put(at(i + d.i, j + d.j), weight, c[5 * a]);
          put(at(i - d.i, j - d.j), weight, c[5 * a]);
        }
      }
  };

  Array<double> sums(3 * lattice.size());
  accumulate(lattice, workers, exchange, &unknowns, sums.data(), vertex_body, edge_body, face_body);
  Array<float> diagonal(lattice.size());
  for (std::size_t i = 0; i < diagonal.size(); ++i) diagonal[i] = sums[3 * i] > 0 ? float(sums[3 * i]) : 1.0f;
  return diagonal;
}

double thin_plate_energy(const Lattice& lattice, const ThinPlateRows<double>& rows, Workers& workers,
                         const double* x) {
  const ControlMesh& mesh = lattice.mesh();
  const int n = lattice.n();
  const JointWeight joint(lattice);
  std::vector<double> vertex(std::size_t(mesh.vertex_count()), 0.0), edge(mesh.edges.size(), 0.0),
      face(mesh.faces.size(), 0.0);
  workers.for_parts(vertex.size(), 256, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v)
      if (rows.stencils.vertex_fit[v])
        vertex[v] = joint.vertex(Index(v)) * vertex_moment(lattice, rows, Index(v), x).square();
  });
  workers.for_parts(n > 1 ? edge.size() : 0, element_grain(n) * std::size_t(n),
                    [&](std::size_t begin, std::size_t end) {
                      std::vector<double> scratch;
                      for (std::size_t e = begin; e < end; ++e) {
                        if (!rows.stencils.edge_fit[e]) continue;
                        const EdgeRingLanes ring(mesh, Index(e));
                        const EdgeLanes<double> lanes(lattice, x, Index(e), scratch);
                        for (int k = 1; k < n; ++k)
                          edge[e] += joint.edge_point(Index(e), k) *
                                     edge_moment(ring, lanes, rows.edge.data() + 24 * e, k).square();
                      }
                    });
  workers.for_parts(face.size(), element_grain(n), [&](std::size_t begin, std::size_t end) {
    double* const gathered =
        room_in(thread_scratch<double>().gathered, 3 * closed_size(true, std::size_t(n)));
    for (std::size_t f = begin; f < end; ++f) {
      if (!rows.stencils.face_fit[f]) continue;
      const bool quad = mesh.faces[f].quad(), weighted = joint.weighs_face(Index(f));
      gather_face(lattice, x, Index(f), gathered);
      const double* g = rows.stencils.face_energy.data() + 12 * f;
      const LatticePoint step[2][4] = {{{1, 0}, {0, 1}, {-1, 1}, {0, 0}}, {{1, 0}, {1, 1}, {0, 1}, {-1, 1}}};
      const auto at = [&](int i, int j) {
        return gathered + 3 * (closed_row(quad, std::size_t(n), std::size_t(j)) + std::size_t(i));
      };
      for (int j = 1; j < n; ++j)
        for (int i = 1; i < (quad ? n : n - j); ++i) {
          Moment<double> moment;
          for (int a = 0; a < (quad ? 4 : 3); ++a) {
            const LatticePoint d = step[quad][a];
            const double *plus = at(i + d.i, j + d.j), *minus = at(i - d.i, j - d.j), *here = at(i, j);
            const double second[3] = {plus[0] + minus[0] - 2 * here[0], plus[1] + minus[1] - 2 * here[1],
                                      plus[2] + minus[2] - 2 * here[2]};
            moment.add(g + a, 4, second);
          }
          face[f] += (weighted ? joint.face_point(Index(f), i, j) : 1.0) * moment.square();
        }
    }
  });
  double total = 0;
  for (const auto& part : {vertex, edge, face})
    for (const double e : part) total += e;
  return total * double(n) * double(n);
}

}  // namespace fairing
