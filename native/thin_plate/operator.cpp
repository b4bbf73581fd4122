// SPDX-License-Identifier: GPL-3.0-or-later
#include "thin_plate/operator.h"

#include <utility>

#include "parallel/cancel.h"
#include "thin_plate/kernels.h"

namespace fairing {
namespace {

using Column = Stencils::Column;

// Three equal numbers for each point of the closed face.
template <class T>
void face_weights(const EnergyWeight& factor, bool quad, int n, Index f, T* weight) {
  for (int j = 0; j <= n; ++j)
    for (int i = 0; i <= (quad ? n : n - j); ++i, weight += 3)
      std::fill(weight, weight + 3, T(factor.face_point(f, i, j)));
}

// Adds the transposed rows of the moments of a run's points, which have rows of their own.
template <class T>
void add_points(const RowRun<const float>& rows, const T* const* at, T* const* target) {
  for (std::size_t i = 0; i < rows.count; ++i) {
    T moment[3][3] = {};
    // differences from the point itself avoid the rounding of the rows' sums
    for (int s = 1; s < rows.slots; ++s)
      for (std::size_t a = 0; a < 3; ++a) {
        const T d = at[s][3 * i + a] - at[0][3 * i + a];
        for (int c = 0; c < 3; ++c) moment[c][a] += T(rows.at(c, s, i)) * d;
      }
    for (int s = 0; s < rows.slots; ++s)
      for (int c = 0; c < 3; ++c)
        for (std::size_t a = 0; a < 3; ++a)
          target[s][3 * i + a] += T(rows.at(c, s, i)) * moment[c][a];
  }
}

// The energy's columns by the points of a ring.
struct PlateRingRows {
  const GridLevel& grid;
  const Stencils& stencils;
  const SurfaceRows* surface = nullptr;
  EnergyWeight factor{grid};
  RowRun<const float> own{};     // with a surface
  std::vector<Column> column{};  // without, by slot
  Run run{};

  void read(const Run& now) {
    run = now;
    if (surface) own = std::as_const(surface->rows).of(run);
    if (surface || run.row > 1) return;
    const std::span<const Column> columns = stencils.columns(element_of(grid.mesh(), run));
    column.clear();
    if (columns.empty()) return;
    column.assign(1, {});
    column.insert(column.end(), columns.begin(), columns.end());
    for (const Column& neighbour : columns)
      for (std::size_t c = 0; c < 3; ++c) column[0][c] -= neighbour[c];
  }
  // None without a fit.
  int slots() const { return surface ? own.slots : int(column.size()); }
  Vec3 at(int s, std::size_t i) const {
    if (surface) return Vec3(own.at(0, s, i), own.at(1, s, i), own.at(2, s, i));
    return Eigen::Map<const Vec3>(column[s].data());
  }
  // Of the energy at point i.
  double weight(std::size_t i) const {
    if (surface) return 1;
    return (factor.weighs(run) ? factor.point(run, i) : 1.0) * grid.n() * grid.n();
  }
  double number(int s, int t, std::size_t i) const { return weight(i) * at(s, i).dot(at(t, i)); }
};

// A thread's passes over runs and faces.
template <class T>
class PlatePass {
 public:
  PlatePass(const GridLevel& grid, const ThinPlateRows<T>& rows, const SurfaceRows* surface,
            const T* x)
      : grid_(grid), rows_(rows), surface_(surface), x_(x), factor_(grid), gather_(grid, x) {
    work_.clear();
  }

  void vertex(Index v, T* centre, T* spokes) {
    spokes_.start(centre);
    visit_ring(grid_, v, [&](Index, std::size_t slot) { spokes_.add(spokes + 3 * slot); });
    add_run(vertex_run(v), spokes_.list());
  }

  void edge(Index e, T* run, T* left, T* right) {
    clear_lanes(grid_.n(), run, left, right);
    T* const lane[3] = {run, left, right};
    for_edge_run(grid_, e, [&](const Run& edge) {
      set_beside_edge<T, 3>(*edge.ring, lane, beside_);
      add_run(edge, beside_.at);
    });
  }

  // The whole face at once, except for rows of its own points and tension.
  void face(Index f, T* closed) {
    const int n = grid_.n();
    const bool quad = grid_.mesh().faces[f].quad();
    const bool at_once = n >= (quad ? 2 : 3) && !surface_;
    if (at_once)
      add_face(f, quad, closed);
    else
      std::fill_n(closed, 3 * closed_size(quad, std::size_t(n)), T(0));
    if (!surface_ && rows_.stencils.tension.empty()) return;
    for_face_runs(grid_, f, [&](const Run& row) {
      set_beside_row<T, 3>(quad, n, row.row, closed, beside_);
      add_run(row, beside_.at);
    });
  }

 private:
  // A vertex has three numbers, for which packs would cost more than its sums.
  template <template <class, int> class Loop, class... Arguments>
  static void pass(const Run& run, Arguments... arguments) {
    if (run.kind == RunKind::vertex)
      Loop<T, int(sizeof(T))>::run(std::size_t(3), arguments...);
    else
      run_loop<Loop, T>(3 * run.count, arguments...);
  }
  T scale() const { return T(grid_.n()) * T(grid_.n()); }

  void add_run(const Run& run, T* const* target) {
    const Stencils& stencils = rows_.stencils;
    const Index element = element_of(grid_.mesh(), run);
    const T* const* at = gather_(run);
    const bool has_fit = stencils.has_fit[element];
    if (has_fit && surface_)
      add_points(std::as_const(surface_->rows).of(run), at, target);
    else if (has_fit && run.kind != RunKind::face_row)
      add_equal(run, element, at, target);
    if (const std::span<const double> tension = stencils.weights(element); !tension.empty())
      pass<passes::MembranePass>(run, tension.size(), tension.data(), at, target[0]);
  }

  void add_equal(const Run& run, Index element, const T* const* at, T* const* target) {
    T* const moments = room_in(work_, 10 * run.count);
    T* weight = factor_.weighs(run) ? moments + 9 * run.count : nullptr;
    for (std::size_t i = 0; i < run.count && weight; ++i) weight[i] = T(factor_.point(run, i));
    const T* row = rows_.ring.data() + 3 * rows_.stencils.begin[element];
    pass<passes::RunPass>(run, rows_.stencils.columns(element).size(), row, scale(), at,
                          static_cast<const T*>(weight), target, moments);
  }

  void add_face(Index f, bool quad, T* closed) {
    const int n = grid_.n();
    const std::size_t size = 3 * closed_size(quad, std::size_t(n));
    T* const x = room_in(thread_scratch<T>().gathered, size + lane_block);
    gather_face(grid_, x_, f, x);
    const T* weight = nullptr;
    if (factor_.weighs_face(f)) {
      weight = room_in(weight_, size);
      face_weights(factor_, quad, n, f, weight_.data());
    }
    T* const moments = room_in(work_, passes::moments_size(n));
    const T* c = rows_.face.data() + 16 * std::size_t(f);
    if (quad)
      set_face_pass<true>(n, c, scale(), x, weight, closed, moments);
    else
      set_face_pass<false>(n, c, scale(), x, weight, closed, moments);
  }

  const GridLevel& grid_;
  const ThinPlateRows<T>& rows_;
  const SurfaceRows* surface_;
  const T* x_;
  EnergyWeight factor_;
  RunGather<T, 3> gather_;
  SpokePointers<T> spokes_;
  RunNeighbours<T> beside_;
  std::vector<T>& work_ = thread_scratch<T>().work;
  std::vector<T> weight_;
};

}  // namespace

template <class T>
ThinPlateRows<T>::ThinPlateRows(const ControlMesh& mesh, const Stencils& s) : stencils(s) {
  const std::size_t rings = s.begin.size() - 1 - mesh.faces.size();
  ring.resize(3 * s.begin[rings]);
  for (std::size_t k = 0; k < ring.size(); ++k) ring[k] = T(s.energy[k / 3][k % 3]);
  face.resize(16 * mesh.faces.size());
  for (const std::size_t f : Cancellable(mesh.faces.size())) {
    const Column* g = s.energy.data() + s.begin[rings + f];
    const std::size_t directions = mesh.faces[f].quad() ? 4 : 3;
    for (std::size_t a = 0; a < directions; ++a)
      for (std::size_t b = 0; b < directions; ++b)
        face[16 * f + 4 * a + b] = T(g[a][0] * g[b][0] + g[a][1] * g[b][1] + g[a][2] * g[b][2]);
  }
}

template struct ThinPlateRows<float>;
template struct ThinPlateRows<double>;

template <class T>
void apply_thin_plate(const GridLevel& grid, const ThinPlateRows<T>& rows, const Unknowns& unknowns,
                      const VertexWeights& weights, Workers& workers, ElementSlots<T>& slots,
                      const T* x, T* y, const SurfaceRows* surface) {
  using Pass = PlatePass<T>;
  accumulate(
      grid, workers, slots, &unknowns, y, [&] { return Pass(grid, rows, surface, x); },
      [](Index v, T* centre, T* spokes, Pass& pass) { pass.vertex(v, centre, spokes); },
      [](Index e, T* run, T* left, T* right, Pass& pass) { pass.edge(e, run, left, right); },
      [](Index f, T* closed, Pass& pass) { pass.face(f, closed); });
  add_weighted(unknowns, weights, workers, x, y);
  if (surface) add_weighted(unknowns, surface->penalty, workers, x, y);
}

template void apply_thin_plate<float>(const GridLevel&, const ThinPlateRows<float>&,
                                      const Unknowns&, const VertexWeights&, Workers&,
                                      ElementSlots<float>&, const float*, float*,
                                      const SurfaceRows*);
template void apply_thin_plate<double>(const GridLevel&, const ThinPlateRows<double>&,
                                       const Unknowns&, const VertexWeights&, Workers&,
                                       ElementSlots<double>&, const double*, double*,
                                       const SurfaceRows*);

Array<float> thin_plate_diagonal(const GridLevel& grid, const Stencils& stencils,
                                 const Unknowns& unknowns, Workers& workers,
                                 ElementSlots<double>& slots, const SurfaceRows* surface) {
  // The sums of K with squared coefficients; all three coordinates have the same number.
  const auto body = [&](const Run& run, double* const* target, PlateRingRows& rows) {
    const auto put = [&](std::size_t slot, std::size_t i, double number) {
      for (std::size_t a = 0; a < 3; ++a) target[slot][3 * i + a] += number;
    };
    const double tension = stencils.total_weight(element_of(grid.mesh(), run));
    for (std::size_t i = 0; i < run.count; ++i) put(0, i, tension);
    rows.read(run);
    for (std::size_t i = 0; i < run.count; ++i)
      for (int s = 0; s < rows.slots(); ++s) put(std::size_t(s), i, rows.number(s, s, i));
  };
  Array<double> sums(3 * grid.size());
  accumulate_runs(
      grid, workers, slots, &unknowns, sums.data(),
      [&] { return PlateRingRows{grid, stencils, surface}; }, body);
  Array<float> diagonal(grid.size());
  for (std::size_t i = 0; i < diagonal.size(); ++i) {
    if (surface) sums[3 * i] += double(surface->penalty[i]);
    diagonal[i] = float(sums[3 * i]);
  }
  return diagonal;
}

double thin_plate_energy(const GridLevel& grid, const Stencils& stencils, Workers& workers,
                         const double* x, const SurfaceRows* surface) {
  ElementSums sums(grid.mesh());
  struct State {
    RunGather<double, 3> gather;
    PlateRingRows rows;
  };
  for_each_run(
      grid, workers, [&] { return State{{grid, x}, {grid, stencils, surface}}; },
      [&](const Run& run, State& state) {
        state.rows.read(run);
        const double* const* at = state.gather(run);
        const int slots = state.rows.slots();
        double& sum = sums.of(run);
        for (std::size_t i = 0; i < run.count; ++i) {
          double moment[9] = {}, square = 0;
          for (int s = 1; s < slots; ++s) {
            const Vec3 row = state.rows.at(s, i);
            for (std::size_t k = 0; k < 9; ++k)
              moment[k] += row[k / 3] * (at[s][3 * i + k % 3] - at[0][3 * i + k % 3]);
          }
          for (const double m : moment) square += m * m;
          sum += state.rows.weight(i) * square;
        }
      });
  return sums.total();
}

// Each point has half of the edges to its neighbours.
double membrane_energy(const GridLevel& grid, const Stencils& stencils, Workers& workers,
                       const double* x) {
  if (stencils.tension.empty()) return 0;
  ElementSums sums(grid.mesh());
  for_each_run(
      grid, workers, [&] { return RunGather<double, 3>(grid, x); },
      [&](const Run& run, RunGather<double, 3>& gather) {
        const std::span<const double> weight = stencils.weights(element_of(grid.mesh(), run));
        const double* const* at = gather(run);
        double sum = 0;
        for (std::size_t i = 0; i < 3 * run.count; ++i)
          for (std::size_t s = 0; s < weight.size(); ++s) {
            const double d = at[0][i] - at[1 + s][i];
            sum += weight[s] * d * d;
          }
        sums.of(run) += 0.5 * sum;
      });
  return sums.total();
}

}  // namespace fairing
