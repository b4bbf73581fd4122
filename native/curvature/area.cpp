// SPDX-License-Identifier: GPL-3.0-or-later
#include "curvature/area.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "curvature/point_curvature.h"
#include "curvature/rings.h"

namespace fairing {
namespace {

// The triangles around the points of a run, by slots.
struct FanTriangle {
  int a, b;
  double share;
};

// A thread's buffers, reused from run to run.
class RunArea {
 public:
  RunArea(const GridLevel& grid, const double* x) : grid_(grid), gather_(grid, x, buffer_) {}
  RunArea(const RunArea&) = delete;

  // Sets `area`, and cotangent(s)[i] for all slots but slot 0. Returns the positions.
  const double* const* operator()(const Run& run) {
    list_triangles(run);
    count_ = run.count;
    cotangents_.assign(std::size_t(slots_) * count_, 0.0);
    area = 0;
    const double* const* x = gather_(run);
    for (const FanTriangle& t : triangles_) add(t, x[0], x[t.a], x[t.b]);
    return x;
  }
  int slots() const { return slots_; }
  double* cotangent(int s) { return cotangents_.data() + std::size_t(s) * count_; }

  double area = 0;  // the points' share: a third of their triangles

 private:
  void list_triangles(const Run& run) {
    if (run.kind == RunKind::face_row && run.row > 1) return;
    shape_.set(grid_, run);
    triangles_.clear();
    const int size = int(shape_.far.size());
    slots_ = size + 1;
    const auto at = [&](int m) { return (shape_.first + m) % size; };
    const auto far = [&](int j) { return shape_.far[j] != 0; };
    for (int m = 1; m < size + (shape_.closed ? 1 : 0); ++m) {
      const int a = at(m - 1), b = at(m);
      triangles_.push_back({a + 1, b + 1, far(a) || far(b) ? 0.5 : 1.0});
      if (far(b)) triangles_.push_back({a + 1, at(m + 1) + 1, 0.5});
    }
  }

  void add(const FanTriangle& t, const double* own, const double* a, const double* b) {
    double *to_a = cotangent(t.a), *to_b = cotangent(t.b), sum = 0;
    for (std::size_t i = 0; i < count_; ++i) {
      const double *o = own + 3 * i, *p = a + 3 * i, *q = b + 3 * i;
      const Vec3 u(p[0] - o[0], p[1] - o[1], p[2] - o[2]), v(q[0] - o[0], q[1] - o[1], q[2] - o[2]);
      const double uu = u.squaredNorm(), vv = v.squaredNorm(), uv = u.dot(v),
                   longest = std::max({uu, vv, (u - v).squaredNorm()}),
                   square = u.cross(v).squaredNorm();
      if (!(square > thinnest_ring_square * longest * longest)) continue;
      const double sine = std::sqrt(square), scale = 0.5 * t.share / sine;
      to_a[i] += scale * (vv - uv);
      to_b[i] += scale * (uu - uv);
      sum += t.share / 6 * sine;
    }
    area += sum;
  }

  const GridLevel& grid_;
  std::vector<double> buffer_, cotangents_;
  RunGather<double, 3> gather_;
  RingShape shape_;
  std::vector<FanTriangle> triangles_;
  int slots_ = 0;
  std::size_t count_ = 0;
};

// Calls visit(run, rings, x) for all runs that are not outside the region. Returns the total area.
template <class Visit>
double visit_areas(const GridLevel& grid, Workers& workers, const double* x, Visit&& visit) {
  ElementSums sums(grid.mesh());
  for_each_run(
      grid, workers, [&] { return RunArea(grid, x); },
      [&](const Run& run, RunArea& rings) {
        if (part_of_region(grid.mesh(), run) == RegionPart::outside) return;
        const double* const* at = rings(run);
        sums.of(run) += rings.area;
        visit(run, rings, at);
      });
  return sums.total();
}

}  // namespace

double surface_area(const GridLevel& grid, Workers& workers, const double* x) {
  return visit_areas(grid, workers, x, [](const Run&, RunArea&, const double* const*) {});
}

double AreaTerm::linearize(double tau, const double* x, const double* normal,
                           const Unknowns& unknowns, Workers& workers, double* force) {
  const auto keep = [&](const Run& run, RunArea& rings, const double* const* at) {
    const RowRun<float> to = weight_.of(run);
    const bool wanted = force && normal && unknowns.has(run);
    for (int s = 1; s < rings.slots(); ++s) {
      const double* cotangent = rings.cotangent(s);
      for (std::size_t i = 0; i < run.count; ++i) to.at(0, s, i) = float(0.5 * tau * cotangent[i]);
      for (std::size_t i = 0; i < run.count && wanted; ++i) {
        const double *n = normal + 3 * (run.first + i), *p = at[0] + 3 * i, *q = at[s] + 3 * i;
        force[run.first + i] +=
            0.5 * tau * cotangent[i] *
            (n[0] * (q[0] - p[0]) + n[1] * (q[1] - p[1]) + n[2] * (q[2] - p[2]));
      }
    }
  };
  return tau * visit_areas(weight_.grid(), workers, x, keep);
}

template <class T>
void AreaTerm::add_product(const Unknowns& unknowns, Workers& workers, const T* h, T* y) const {
  for_each_run(
      weight_.grid(), workers, [&] { return RunGather<T>(weight_.grid(), h); },
      [&](const Run& run, RunGather<T>& gather) {
        if (!unknowns.has(run)) return;
        const RowRun<const float> row = weight_.of(run);
        const T* const* at = gather(run);
        T* to = y + run.first;
        for (int s = 1; s < row.slots; ++s) {
          const float* weight = &row.at(0, s, 0);
          for (std::size_t i = 0; i < run.count; ++i) to[i] += T(weight[i]) * (at[0][i] - at[s][i]);
        }
      });
}

template void AreaTerm::add_product<float>(const Unknowns&, Workers&, const float*, float*) const;
template void AreaTerm::add_product<double>(const Unknowns&, Workers&, const double*,
                                            double*) const;

void AreaTerm::add_diagonal(const Unknowns& unknowns, float* diagonal) const {
  for_each_run(weight_.grid(), [&](const Run& run) {
    if (!unknowns.has(run)) return;
    const RowRun<const float> row = weight_.of(run);
    for (int s = 1; s < row.slots; ++s)
      for (std::size_t i = 0; i < run.count; ++i) diagonal[run.first + i] += row.at(0, s, i);
  });
}

void AreaTerm::add_entries(const std::vector<Index>& number,
                           std::vector<Eigen::Triplet<double>>& entries) const {
  visit_rows(weight_, [&](Index p, const RowRun<const float>& run, std::size_t i,
                          const std::vector<Index>& at) {
    const Index row = number[p];
    for (int s = 1; s < run.slots && row >= 0; ++s) {
      const double weight = run.at(0, s, i);
      entries.emplace_back(row, row, weight);
      const Index column = number[at[s]];
      if (column >= 0) entries.emplace_back(row, column, -weight);
    }
  });
}

}  // namespace fairing
