// SPDX-License-Identifier: GPL-3.0-or-later
#include "thin_plate/operator.h"

#include "multigrid/ring_lines.h"
#include "parallel/cancel.h"
#include "parallel/reductions.h"
#include "thin_plate/kernels.h"
#include "thin_plate/membrane.h"

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
  // The transposed rows for one neighbour.
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
Moment<T> vertex_moment(const GridLevel& grid, const ThinPlateRows<T>& rows, Index v, const T* x) {
  Moment<T> moment;
  const T* row = rows.vertex.data() + 3 * std::size_t(rows.stencils.ring_offset[std::size_t(v)]);
  visit_ring(grid, v, [&](Index point, std::size_t) {
    T d[3];
    difference(x + 3 * std::size_t(point), x + 3 * std::size_t(v), d);
    moment.add(row, 1, d);
    row += 3;
  });
  return moment;
}

template <class T>
void edge_weights(const EnergyWeight& factor, int n, Index e, T* weight) {
  for (int k = 1; k < n; ++k) *weight++ = T(factor.edge_point(e, k));
}

// Three equal numbers for each point of the closed face.
template <class T>
void face_weights(const EnergyWeight& factor, bool quad, int n, Index f, T* weight) {
  for (int j = 0; j <= n; ++j)
    for (int i = 0; i <= (quad ? n : n - j); ++i, weight += 3)
      std::fill(weight, weight + 3, T(factor.face_point(f, i, j)));
}

// The energy's rows of a run's element.
struct ElementRows {
  using Column = EnergyRows::Column;
  const ControlMesh& mesh;
  const Stencils& stencils;
  // By neighbour; inside a face by direction, for second differences. Empty: no fit.
  std::vector<Column> column{};

  void read(const Run& run) {
    if (run.row > 1) return;
    const EnergyRows rows(mesh, stencils, element_of(mesh, run));
    column.clear();
    for (std::size_t k = 0; k < rows.distinct(); ++k) column.push_back(rows[k]);
  }
};

// y += W x at the control vertices.
template <class T>
void add_weighted(const GridLevel& grid, const VertexWeights& weights, Workers& workers, const T* x,
                  T* y) {
  const auto first = std::size_t(grid.mesh().vertex_count());
  if (weights.size() <= first) return;
  for_each_index(workers, weights.size() - first, [&](std::size_t i) {
    const std::size_t p = first + i;
    for (std::size_t a = 0; a < 3; ++a) y[3 * p + a] += T(weights[p]) * x[3 * p + a];
  });
}

double dot(const EnergyRows::Column& a, const EnergyRows::Column& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

// The energy's columns by the points of a ring, in the form that multigrid/ring_lines.h reads.
struct PlateRingRows {
  const GridLevel& grid;
  EnergyWeight factor;
  ElementRows rows;
  std::vector<EnergyRows::Column> column{};  // by slot
  Run run{};

  void read(const Run& now) {
    run = now;
    if (run.row > 1) return;
    rows.read(run);
    column.assign(1, {});
    for (int side = 0; side < (run.kind == RunKind::face_row ? 2 : 1); ++side)
      for (const auto& neighbour : rows.column) {
        column.push_back(neighbour);
        for (std::size_t c = 0; c < 3; ++c) column[0][c] -= neighbour[c];
      }
    if (rows.column.empty()) column.clear();
  }
  int slots() const { return int(column.size()); }
  double number(int s, int t, std::size_t i) const {
    const double weight = factor.weighs(run) ? factor.point(run, i) : 1.0;
    return weight * grid.n() * grid.n() * dot(column[std::size_t(s)], column[std::size_t(t)]);
  }
  float product(int s, int t, std::size_t i) const { return float(number(s, t, i)); }
  bool is_same_along_run() const { return !factor.weighs(run); }
};

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
void apply_thin_plate(const GridLevel& grid, const ThinPlateRows<T>& rows, const Unknowns& unknowns,
                      const VertexWeights& weights, Workers& workers, ElementSlots<T>& slots,
                      const T* x, T* y) {
  const ControlMesh& mesh = grid.mesh();
  const int n = grid.n();
  const T level_scale = T(n) * T(n);
  const EnergyWeight factor(grid);
  const MembraneRows<T> membrane(grid, rows.stencils, unknowns, x);

  const auto vertex_body = [&](Index v, T* centre, T* spokes, std::vector<T>&) {
    if (rows.stencils.vertex_fit[std::size_t(v)]) {
      const T scale = level_scale * T(factor.vertex(v));
      const Moment<T> moment = vertex_moment(grid, rows, v, x);
      const T* row =
          rows.vertex.data() + 3 * std::size_t(rows.stencils.ring_offset[std::size_t(v)]);
      visit_ring(grid, v, [&](Index, std::size_t slot) {
        T z[3];
        moment.transposed(row, 1, z);
        row += 3;
        for (std::size_t a = 0; a < 3; ++a) {
          spokes[3 * slot + a] += scale * z[a];
          centre[a] -= scale * z[a];
        }
      });
    }
    membrane.add_vertex(v, centre);
    if (!weights.empty())
      for (std::size_t a = 0; a < 3; ++a)
        centre[a] += T(weights[std::size_t(v)]) * x[3 * std::size_t(v) + a];
  };

  const auto edge_body = [&](Index e, T* run, T* left, T* right, std::vector<T>& scratch) {
    if (n == 1 || !rows.stencils.edge_fit[std::size_t(e)]) {
      clear_lanes(n, run, left, right);
      return;
    }
    const std::size_t stride = lane_stride(n) + lane_block;
    if (scratch.size() < 9 * stride) scratch.resize(9 * stride);
    const EdgeRingLanes ring(mesh, e);
    const EdgeLanes<T> lanes(grid, x, e, scratch);
    T* const target[3] = {run, left, right};
    T* weight = factor.weighs_edge(e) ? scratch.data() + 8 * stride : nullptr;
    if (weight) edge_weights(factor, n, e, weight);
    set_edge_pass(n, ring, rows.edge.data() + 24 * std::size_t(e), level_scale, lanes.lane, weight,
                  target, scratch.data() + 3 * stride);
    membrane.add_edge(e, ring, lanes.lane, run);
  };

  const auto face_body = [&](Index f, T* closed, std::vector<T>& scratch) {
    const bool quad = mesh.faces[std::size_t(f)].quad();
    const std::size_t size = 3 * closed_size(quad, std::size_t(n)) + lane_block;
    const std::size_t moments = passes::moments_size(n);
    if (n < (quad ? 2 : 3)) {
      std::fill(closed, closed + 3 * closed_size(quad, std::size_t(n)), T(0));
      return;
    }
    const bool weighted = factor.weighs_face(f);
    if (scratch.size() < moments) scratch.resize(moments);
    T* gathered = room_in(thread_scratch<T>().gathered, (weighted ? 2 : 1) * size);
    gather_face(grid, x, f, gathered);
    T* weight = weighted ? gathered + size : nullptr;
    if (weight) face_weights(factor, quad, n, f, weight);
    const T* c = rows.face.data() + 16 * std::size_t(f);
    if (quad)
      set_face_pass<true>(n, c, level_scale, gathered, weight, closed, scratch.data());
    else
      set_face_pass<false>(n, c, level_scale, gathered, weight, closed, scratch.data());
    membrane.add_face(f, gathered, closed);
  };

  accumulate(grid, workers, slots, &unknowns, y, vertex_body, edge_body, face_body);
  add_weighted(grid, weights, workers, x, y);
}

template void apply_thin_plate<float>(const GridLevel&, const ThinPlateRows<float>&,
                                      const Unknowns&, const VertexWeights&, Workers&,
                                      ElementSlots<float>&, const float*, float*);
template void apply_thin_plate<double>(const GridLevel&, const ThinPlateRows<double>&,
                                       const Unknowns&, const VertexWeights&, Workers&,
                                       ElementSlots<double>&, const double*, double*);

Array<float> thin_plate_diagonal(const GridLevel& grid, const Stencils& stencils,
                                 const Unknowns& unknowns, const VertexWeights& weights,
                                 Workers& workers, ElementSlots<double>& slots) {
  // The sums of K with squared coefficients; all three coordinates have the same number.
  const auto body = [&](const Run& run, double* const* target, PlateRingRows& rows) {
    const auto put = [&](std::size_t slot, std::size_t i, double number) {
      for (std::size_t a = 0; a < 3; ++a) target[slot][3 * i + a] += number;
    };
    if (run.kind == RunKind::vertex && !weights.empty())
      put(0, 0, weights[std::size_t(run.element)]);
    if (stencils.membrane.any()) {
      const MembraneWeights membrane(grid.mesh(), stencils, element_of(grid.mesh(), run));
      for (std::size_t i = 0; i < run.count; ++i) put(0, i, membrane.total());
    }
    rows.read(run);
    for (std::size_t i = 0; i < run.count; ++i)
      for (int s = 0; s < rows.slots(); ++s) put(std::size_t(s), i, rows.number(s, s, i));
  };
  Array<double> sums(3 * grid.size());
  accumulate_runs(
      grid, workers, slots, &unknowns, sums.data(),
      [&] { return PlateRingRows{grid, EnergyWeight(grid), {grid.mesh(), stencils}}; }, body);
  Array<float> diagonal(grid.size());
  const auto vertices = std::size_t(grid.mesh().vertex_count());
  for (std::size_t i = 0; i < diagonal.size(); ++i) {
    if (i >= vertices && i < weights.size()) sums[3 * i] += weights[i];
    diagonal[i] = sums[3 * i] > 0 ? float(sums[3 * i]) : 1.0f;
  }
  return diagonal;
}

void write_plate_lines(const GridLevel& grid, const Stencils& stencils, const Unknowns& unknowns,
                       const Array<float>& inverse_diagonal, Workers& workers, LineBand& band) {
  write_ring_lines(grid, unknowns, inverse_diagonal, workers,
                   PlateRingRows{grid, EnergyWeight(grid), {grid.mesh(), stencils}}, band);
}

double thin_plate_energy(const GridLevel& grid, const Stencils& stencils, Workers& workers,
                         const double* x) {
  const EnergyWeight factor(grid);
  ElementSums sums(grid.mesh());
  struct Local {
    RunGather<double, 3> gather;
    ElementRows rows;
  };
  for_each_run(
      grid, workers, [&] { return Local{{grid, x}, {grid.mesh(), stencils}}; },
      [&](const Run& run, Local& local) {
        local.rows.read(run);
        const std::size_t columns = local.rows.column.size();
        if (columns == 0) return;
        const double* const* at = local.gather(run);
        const bool weighted = factor.weighs(run), second = run.kind == RunKind::face_row;
        double& sum = sums.of(run);
        for (std::size_t i = 0; i < run.count; ++i) {
          Moment<double> moment;
          const double* const here = at[0] + 3 * i;
          for (std::size_t k = 0; k < columns; ++k) {
            const double* const plus = at[1 + k] + 3 * i;
            double d[3];
            if (second) {
              const double* const minus = at[1 + columns + k] + 3 * i;
              for (std::size_t a = 0; a < 3; ++a) d[a] = plus[a] + minus[a] - 2 * here[a];
            } else {
              difference(plus, here, d);
            }
            moment.add(local.rows.column[k].data(), 1, d);
          }
          sum += (weighted ? factor.point(run, i) : 1.0) * moment.square();
        }
      });
  return sums.total() * double(grid.n()) * double(grid.n());
}

}  // namespace fairing
