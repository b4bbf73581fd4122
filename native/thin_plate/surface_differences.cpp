// SPDX-License-Identifier: GPL-3.0-or-later
#include "thin_plate/surface_differences.h"

#include <Eigen/Geometry>
#include <cmath>

#include "grid/ring_shape.h"
#include "grid/runs.h"
#include "parallel/reductions.h"
#include "stencil/surface_chart.h"

namespace fairing {
namespace {

// The point's share of the ring's area, as Chart::area, with the ring's own lengths.
double area_of(const SpaceRing& ring) {
  const std::size_t size = ring.offset.size();
  double sum = 0;
  for (std::size_t k = 0; k < (ring.closed ? size : size - 1); ++k) {
    const std::size_t i = (ring.first + k) % size, j = (i + 1) % size;
    const double faces = ring.far[i] || ring.far[j] ? 4 : 3;
    sum += 0.5 * ring.offset[i].cross(ring.offset[j]).norm() / faces;
  }
  return sum;
}

// The point's part of the energy of its ring, by its rows, which begin with its own numbers.
double bending_of(const SpaceRing& ring, const float* rows) {
  Eigen::Matrix3d moments = Eigen::Matrix3d::Zero();
  for (const Vec3& offset : ring.offset) {
    rows += 3;
    moments += offset * Vec3(rows[0], rows[1], rows[2]).transpose();
  }
  return moments.squaredNorm();
}

Unknowns everything(const ControlMesh& mesh) {
  return {std::vector<std::uint8_t>(std::size_t(mesh.vertex_count()), 1),
          std::vector<std::uint8_t>(mesh.edges.size(), 1), true};
}

template <class Body>
void for_each_point(Workers& workers, std::size_t points, Body&& body) {
  workers.for_parts(points, vertex_grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t p = begin; p < end; ++p) body(p);
  });
}

}  // namespace

SurfaceDifferences::SurfaceDifferences(const GridLevel& grid, const Stencils& stencils,
                                       const SurfaceMetric& metric, const Unknowns& unknowns,
                                       Workers& workers)
    : grid_(grid),
      stencils_(stencils),
      unknown_(unknown_points(grid, unknowns)),
      rings_(grid, everything(grid.mesh()), workers),
      places_(rings_) {
  const RingTable::Ring& last = rings_.about(Index(rings_.points() - 1));
  row_.resize(3 * (last.member + last.size));
  penalty_.resize(rings_.points());
  write_rows(metric, workers);
}

void SurfaceDifferences::write_rows(const SurfaceMetric& metric, Workers& workers) {
  struct Local {
    RunGather<double, 3> gather;
    RingShape shape{};
    std::vector<Vec3> offset{};
    Chart chart{};
  };
  const double n = double(grid_.n());
  const Array<double> weight = point_weights(grid_);
  for_each_run(
      grid_, workers, [&] { return Local{{grid_, metric.surface}}; },
      [&](const Run& run, Local& local) {
        const EnergyRows usual(grid_.mesh(), stencils_, element_of(grid_.mesh(), run));
        const std::size_t ring = rings_.about(Index(run.first)).size - 1;
        const double* const* at = local.gather(run);
        local.shape.set(grid_, run);
        local.offset.resize(ring);
        for (std::size_t i = 0; i < run.count; ++i) {
          const std::size_t p = run.first + i;
          float* const to = row_.data() + 3 * rings_.about(Index(p)).member;
          std::fill(to, to + 3 * (ring + 1), 0.0f);
          penalty_[p] = 0;
          if (usual.size() == 0) continue;
          for (std::size_t s = 0; s < ring; ++s)
            for (int a = 0; a < 3; ++a)
              local.offset[s][a] =
                  n * (at[s + 1][3 * i + std::size_t(a)] - at[0][3 * i + std::size_t(a)]);
          const SpaceRing in_space{local.offset, local.shape.far, std::size_t(local.shape.first),
                                   local.shape.closed};
          const double share = weight.empty() ? 1.0 : weight[p], scale = n * std::sqrt(share);
          const auto put = [&](auto&& row) {
            for (std::size_t c = 0; c < 3; ++c) {
              double own = 0;  // constants have no differences
              for (std::size_t s = 0; s < ring; ++s)
                own -= double(to[3 * (s + 1) + c] = float(scale * row(c, s)));
              to[c] = float(own);
            }
          };
          if (!chart_in_space(in_space, metric.exponent, local.chart)) {
            put([&](std::size_t c, std::size_t s) { return usual[s][c]; });
            continue;
          }
          const FitRows rows = fit(local.chart);
          const double root = std::sqrt(local.chart.area);
          put([&](std::size_t c, std::size_t s) {
            return root * rows(Eigen::Index(c + 2), Eigen::Index(s));
          });
          if (is_unknown(Index(p)))
            penalty_[p] = float(bending_of(in_space, to) / (n * n) *
                                std::pow(area_of(in_space), 2) * std::pow(metric.penalty[p], 4));
        }
      });
}

template <>
Array<double>& SurfaceDifferences::moments<double>() {
  return moment_;
}
template <>
Array<float>& SurfaceDifferences::moments<float>() {
  return float_moment_;
}

template <class T>
void SurfaceDifferences::compute_moments(Workers& workers, const T* x) {
  Array<T>& moment = moments<T>();
  moment.resize(9 * rings_.points());
  for_each_point(workers, rings_.points(), [&](std::size_t p) {
    const RingTable::Ring& ring = rings_.about(Index(p));
    const RingTable::Member* const members = rings_.members(ring);
    const float* row = row_.data() + 3 * ring.member;
    // differences from the point itself avoid the rounding of the rows' sums
    const T* const own = x + 3 * p;
    T sum[9] = {};
    for (std::size_t s = 1; s < ring.size; ++s) {
      const T* const other = x + 3 * std::size_t(members[s]);
      for (std::size_t a = 0; a < 3; ++a) {
        const T d = other[a] - own[a];
        for (std::size_t c = 0; c < 3; ++c) sum[3 * c + a] += T(row[3 * s + c]) * d;
      }
    }
    std::copy_n(sum, 9, moment.data() + 9 * p);
  });
}

template <class T>
void SurfaceDifferences::apply(const std::vector<std::uint8_t>& vertices,
                               const VertexWeights& weights, Workers& workers, const T* x, T* y) {
  compute_moments(workers, x);
  const T* const moment = moments<T>().data();
  for_each_point(workers, rings_.points(), [&](std::size_t p) {
    T sum[3] = {};
    if (p < vertices.size() ? vertices[p] : unknown_[p]) {
      for (const RingPlaces::Place& place : places_.of(Index(p))) {
        const float* const row = row_.data() + 3 * (rings_.about(place.centre).member + place.slot);
        const T* const m = moment + 9 * std::size_t(place.centre);
        for (std::size_t c = 0; c < 3; ++c)
          for (std::size_t a = 0; a < 3; ++a) sum[a] += T(row[c]) * m[3 * c + a];
      }
      const RingTable::Member* const members = rings_.members(rings_.about(Index(p)));
      const MembraneWeights tension = membrane(Index(p));
      for (std::size_t s = 0; s < tension.size(); ++s)
        for (std::size_t a = 0; a < 3; ++a)
          sum[a] += T(tension[s]) * (x[3 * p + a] - x[3 * std::size_t(members[s + 1]) + a]);
      const T held = T(penalty_[p]) + T(p < weights.size() ? weights[p] : 0.0);
      for (std::size_t a = 0; a < 3; ++a) sum[a] += held * x[3 * p + a];
    }
    std::copy_n(sum, 3, y + 3 * p);
  });
}
template void SurfaceDifferences::apply<float>(const std::vector<std::uint8_t>&,
                                               const VertexWeights&, Workers&, const float*,
                                               float*);
template void SurfaceDifferences::apply<double>(const std::vector<std::uint8_t>&,
                                                const VertexWeights&, Workers&, const double*,
                                                double*);

Array<float> SurfaceDifferences::diagonal(const std::vector<std::uint8_t>& vertices,
                                          const VertexWeights& weights, Workers& workers) const {
  Array<float> out(rings_.points());
  for_each_point(workers, rings_.points(), [&](std::size_t p) {
    double sum = penalty(Index(p)) + (p < weights.size() ? weights[p] : 0.0);
    for (const RingPlaces::Place& place : places_.of(Index(p)))
      for (const double number : column(place.centre, place.slot)) sum += number * number;
    sum += membrane(Index(p)).total();
    out[p] = (p < vertices.size() ? vertices[p] : unknown_[p]) && sum > 0 ? float(sum) : 1.0f;
  });
  return out;
}

void SurfaceDifferences::add_penalty(const double* reference, Workers& workers, double* r) const {
  for_each_point(workers, rings_.points(), [&](std::size_t p) {
    if (!is_unknown(Index(p))) return;
    for (std::size_t a = 0; a < 3; ++a) r[3 * p + a] += penalty(Index(p)) * reference[3 * p + a];
  });
}

double SurfaceDifferences::energy(Workers& workers, const double* x) {
  compute_moments(workers, x);
  return sum(workers, moment_.size(), [&](std::size_t i) { return moment_[i] * moment_[i]; });
}

}  // namespace fairing
