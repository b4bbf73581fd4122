// SPDX-License-Identifier: GPL-3.0-or-later
#include "curvature/fold_repair.h"

#include <Eigen/Geometry>
#include <Eigen/SparseLU>
#include <cmath>

#include "grid/linear.h"
#include "grid/ring_shape.h"
#include "parallel/reductions.h"

namespace fairing {
namespace {

// Most times that the places of all folds so far are filled again, each time with one more ring of
// neighbours.
constexpr int most_repairs = 3;
constexpr int rings = 2;  // in the first round

using Map = Eigen::Map<const Vec3>;
using Matrix = Eigen::SparseMatrix<double>;

// A point's ring without the far corners of quads.
struct Ring {
  std::vector<Index> points;
  bool closed = true;
};

// Calls visit(point, ring) for the marked unknowns in order; `ring` is reused.
template <class Visit>
void visit_marked(const GridLevel& grid, const Unknowns& unknowns, const Array<float>& marks,
                  Visit&& visit) {
  Ring ring;
  RingShape shape;
  std::vector<Index> all;
  for_each_run(grid, [&](const Run& run) {
    if (!unknowns.has(run)) return;
    for (std::size_t i = 0; i < run.count; ++i) {
      const Index p = Index(run.first + i);
      if (!(marks[p] > 0)) continue;
      shape.set(grid, run);
      all.clear();
      append_ring(grid, run, i, all);
      ring = {{}, shape.closed};
      for (std::size_t m = 0; m < all.size(); ++m) {
        const std::size_t k = (std::size_t(shape.first) + m) % all.size();
        if (!shape.far[k]) ring.points.push_back(all[k]);
      }
      visit(p, ring);
    }
  });
}

// tan(angle / 2) between two directions.
double half_tangent(const Vec3& a, const Vec3& b) {
  return std::tan(std::atan2(a.cross(b).norm(), a.dot(b)) / 2);
}

// Weights that sum to one. A neighbour that coincides with the point has all the weight, as in the
// limit.
void mean_value_weights(const double* shape, Index point, const Ring& ring,
                        std::vector<double>& weights) {
  const std::size_t size = ring.points.size();
  const auto offset = [&](std::size_t j) {
    return Vec3(Map(shape + 3 * std::size_t(ring.points[j])) - Map(shape + 3 * std::size_t(point)));
  };
  const auto is_there = [&](std::size_t j) { return offset(j).isZero(0); };
  weights.assign(size, 0.0);
  double there = 0;
  for (std::size_t j = 0; j < size; ++j) there += weights[j] = is_there(j);
  for (double& w : weights) w /= std::max(there, 1.0);
  if (there > 0) return;
  for (std::size_t j = 0; j + (ring.closed ? 0 : 1) < size; ++j) {
    const std::size_t after = (j + 1) % size;
    const double t = half_tangent(offset(j), offset(after));
    weights[j] += t;
    weights[after] += t;
  }
  double total = 0;
  for (std::size_t j = 0; j < size; ++j) total += weights[j] /= offset(j).norm();
  for (double& w : weights) w /= total;
}

}  // namespace

void fill_harmonically(const GridLevel& grid, const Unknowns& unknowns, const Array<float>& marks,
                       const double* shape, double* x) {
  std::vector<Index> filled;
  visit_marked(grid, unknowns, marks, [&](Index p, const Ring&) { filled.push_back(p); });
  if (filled.empty()) return;
  std::sort(filled.begin(), filled.end());
  const auto number_of = [&](Index p) {
    const auto at = std::lower_bound(filled.begin(), filled.end(), p);
    return at != filled.end() && *at == p ? Eigen::Index(at - filled.begin()) : Eigen::Index(-1);
  };
  const auto size = Eigen::Index(filled.size());
  std::vector<Eigen::Triplet<double>> entries;
  Eigen::MatrixX3d known = Eigen::MatrixX3d::Zero(size, 3);
  std::vector<double> weights;
  visit_marked(grid, unknowns, marks, [&](Index p, const Ring& ring) {
    const Eigen::Index row = number_of(p);
    entries.emplace_back(row, row, 1.0);
    mean_value_weights(shape, p, ring, weights);
    for (std::size_t j = 0; j < weights.size(); ++j) {
      const Eigen::Index column = number_of(ring.points[j]);
      if (column >= 0)
        entries.emplace_back(row, column, -weights[j]);
      else
        known.row(row) += weights[j] * Map(x + 3 * std::size_t(ring.points[j])).transpose();
    }
  });
  Matrix matrix(size, size);
  matrix.setFromTriplets(entries.begin(), entries.end());
  Eigen::SparseLU<Matrix> factor(matrix);
  if (factor.info() != Eigen::Success) return;
  const Eigen::MatrixX3d targets = factor.solve(known);
  for (Eigen::Index i = 0; i < size; ++i)
    for (Eigen::Index a = 0; a < 3; ++a)
      x[3 * std::size_t(filled[i]) + std::size_t(a)] = targets(i, a);
}

Folds folds_of(const SurfaceIterate& it) {
  return find_folds(it.grid(), it.workers(), it.current.points.data(), it.folded_faces);
}

namespace {

void dilate_marks(SurfaceIterate& it, int by, Array<float>& marks) {
  for (int r = 0; r < by; ++r)
    dilate(it.grid(), it.workers(), it.system.shared().float_slots, nullptr, marks);
}

// Places the marked points between their neighbours as they lie on the control mesh.
void refill(SurfaceIterate& it, const Array<float>& marks, Array<double>& x) {
  const Unknowns& unknowns = it.system.shared().unknowns;
  Array<double> linear(x.size());
  refine_linearly(it.grid(), it.constraints.targets(), it.workers(), linear.data());
  fill_harmonically(it.grid(), it.constraints.any() ? it.constraints.without_held() : unknowns,
                    marks, linear.data(), x.data());
  it.system.symmetrize(it.level, x);
}

}  // namespace

void repair_folds(SurfaceIterate& it, const StepStart& start, CurvatureLevelReport& report) {
  const std::size_t points = it.grid().size();
  Folds folds = folds_of(it);
  report.folds_before = report.folds = folds.count();
  if (report.folds == 0) return;
  LinearizedSurface best = it.current;
  Array<float> folded(points, 0.0f), marks;
  for (int round = 0; round < most_repairs && report.folds > 0; ++round) {
    mark_folds(it.grid(), it.current.points.data(), folds, marks);
    for_each_index(it.workers(), points,
                   [&](std::size_t i) { folded[i] = std::max(folded[i], marks[i]); });
    marks = folded;
    dilate_marks(it, rings + round, marks);
    StepStart filled = start;
    refill(it, marks, filled.points);
    CurvatureLevelReport again;
    run_damped(it, filled, marks, again);
    folds = folds_of(it);
    again.folds_before = report.folds_before;
    again.folds = folds.count();
    // The energy mostly falls, since the folds had trapped the steps.
    const double most = again.folds < report.folds
                            ? std::min(other_minimum * report.energy, report.plate_energy)
                            : report.energy / other_minimum;
    if (!(again.energy <= most)) break;
    report = again;
    best = it.current;
  }
  it.current = std::move(best);
}

}  // namespace fairing
