// SPDX-License-Identifier: GPL-3.0-or-later
#include "constraints/couples.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "constraints/multipliers.h"
#include "grid/ring.h"
#include "grid/runs.h"
#include "stencil/fit.h"

namespace fairing {
Couples::Couples(const ControlMesh& mesh, const ChartMaker& charts,
                 std::vector<FixedNormal> normals, Workers& workers)
    : mesh_(mesh), workers_(workers), normals_(std::move(normals)) {
  first_arm_.assign(1, 0);
  first_row_.assign(1, 0);
  for (const FixedNormal& fixed : normals_) {
    first_arm_.push_back(first_arm_.back() + mesh.ring(fixed.vertex).size());
    const bool half = !mesh.vertex_fit(fixed.vertex);
    first_row_.push_back(first_row_.back() + (half ? mesh.ring(fixed.vertex).size()
                                                   : std::size_t(ring_size(mesh, fixed.vertex))));
  }
  arms_.resize(first_arm_.back());
  rows_.resize(first_row_.back());
  workers_.for_each(size(), vertex_grain, [&](std::size_t c) {
    Chart chart = charts.vertex(normals_[c].vertex);
    const double radius = mean_radius(chart);
    for (Vec2& p : chart.ring) p /= radius;
    if (on_border(c)) {
      fill_border_rows(c, chart);
      fill_arms(c, chart, charts.flat());
      return;
    }
    fill_arms(c, chart, charts.flat());
    const FitRows rows = fit(chart);
    for (std::size_t k = first_row_[c]; k < first_row_[c + 1]; ++k)
      rows_[k] = rows.col(Eigen::Index(k - first_row_[c])).head<2>();
  });
}

// From the slopes D_s along spokes d_s, of length one in the chart's plane. Along the border: the mean
// of both sides. Across: least squares, with x_u given.
//
//   x_u = (D_first / |d_first| - D_last / |d_last|) / 2,
//   x_v = sum_s v_s (D_s - u_s x_u) / sum_s v_s^2, over the spokes inside
//
// Leaves (0, v) in the chart.
void Couples::fill_border_rows(std::size_t c, Chart& chart) {
  const auto ring = mesh_.ring(normals_[c].vertex);
  const Vec2 first = chart.ring.front(), last = chart.ring.back();
  const Vec2 along = (first - last).normalized(), across(-along.y(), along.x());
  Vec2* const rows = rows_.data() + first_row_[c];
  std::size_t at = 0;
  double squares = 0, shear = 0;
  for (std::size_t s = 0; s < ring.size(); ++s) {
    const Vec2 spoke(along.dot(chart.ring[at]), across.dot(chart.ring[at]));
    rows[s] = Vec2::Zero();
    if (s > 0 && s + 1 < ring.size()) {
      rows[s].y() = spoke.y();
      squares += spoke.y() * spoke.y();
      shear += spoke.x() * spoke.y();
    }
    at += ring[s].face >= 0 && mesh_.faces[ring[s].face].quad() ? 2 : 1;
  }
  for (std::size_t s = 0; s < ring.size(); ++s) rows[s] /= squares;
  rows[0] = Vec2(1, -shear / squares) / (2 * first.norm());
  rows[ring.size() - 1] = Vec2(-1, shear / squares) / (2 * last.norm());
  for (Vec2& p : chart.ring) p = Vec2(0, across.dot(p));
}

void Couples::fill_arms(std::size_t c, const Chart& chart, const std::vector<FlatFace>& flat) {
  const auto ring = mesh_.ring(normals_[c].vertex);
  const auto weight = [&](Index face) {
    return (mesh_.faces[face].quad() ? 1 : 2) * flat[face].area;
  };
  std::size_t at = 0;
  for (std::size_t s = 0; s < ring.size(); ++s) {
    Arm& arm = arms_[first_arm_[c] + s];
    arm = {chart.ring[at++], Vec2::Zero(), Vec2::Zero(), 0, 0};
    for (const Index side : mesh_.edges[ring[s].edge].side)
      if (side >= 0) arm.edge_weight += weight(mesh_.sides[side].face) / 2;
    if (ring[s].face < 0) continue;
    arm.face_weight = weight(ring[s].face);
    if (mesh_.faces[ring[s].face].quad()) arm.far = chart.ring[at++];
    arm.behind = chart.ring[at < chart.ring.size() ? at : 0];
  }
}

// Calls visit(point, Omega, (u, v), phi) under a hat except at its top, where psi is zero.
template <class Visit>
void LevelCouples::visit_points(std::size_t c, Visit&& visit) const {
  const int n = grid_.n();
  const int reach = std::max(n / 2, 2);  // half the faces, so that hats do not overlap
  const double step = 1.0 / n, share = step * step, fall = 1.0 / reach;
  const ControlMesh& mesh = grid_.mesh();
  const auto ring = mesh.ring(couples_.normals_[c].vertex);
  for (std::size_t s = 0; s < ring.size(); ++s) {
    const Spoke& spoke = ring[s];
    const Couples::Arm& arm = couples_.arms_[couples_.first_arm_[c] + s];
    const bool curve = mesh.feature_edge[spoke.edge] != 0;
    for (int k = 1; k < reach && !curve; ++k)
      visit(grid_.edge_point(spoke.edge, spoke.outward ? k : n - k), share * arm.edge_weight,
            Vec2(k * step * arm.ahead), 1 - k * fall);
    if (spoke.face < 0) continue;
    const bool quad = mesh.faces[spoke.face].quad();
    for (int r = 1; r < reach; ++r) {
      stop_in_large_face(r);
      for (int k = 1; k < (quad ? reach : reach - r); ++k) {
        const double a = k * step, b = r * step;
        const Index p =
            grid_.face_point(spoke.face, closed_point(quad, n, int(spoke.corner), k, r));
        if (quad)
          visit(p, share * arm.face_weight,
                Vec2(a * (1 - b) * arm.ahead + a * b * arm.far + (1 - a) * b * arm.behind),
                (1 - k * fall) * (1 - r * fall));
        else
          visit(p, share * arm.face_weight, Vec2(a * arm.ahead + b * arm.behind),
                1 - (k + r) * fall);
      }
    }
  }
}

LevelCouples::LevelCouples(const Couples& couples, const GridLevel& grid)
    : couples_(couples), grid_(grid), total_(size(), 0.0), mass_(size(), Vec2::Zero()) {
  Workers& workers = couples_.workers_;
  workers.for_each(size(), element_grain(grid_.n()), [&](std::size_t c) {
    visit_points(c, [&](Index, double weight, const Vec2& uv, double hat) {
      total_[c] += weight * hat * uv.squaredNorm();
      mass_[c] += weight * hat * hat * uv.cwiseAbs2();
    });
  });
}

void LevelCouples::add(const std::vector<Couple>& couples, double* r) const {
  // Whole hats overlap: one after another.
  const bool meet = grid_.n() < 1 << Couples::first_level;
  const std::size_t grain = meet ? size() : element_grain(grid_.n());
  couples_.workers_.for_each(size(), grain, [&](std::size_t c) {
    const Couple& couple = couples[c];
    if (couple.isZero(0)) return;
    visit_points(c, [&](Index p, double weight, const Vec2& uv, double hat) {
      Eigen::Map<Vec3>(r + 3 * std::size_t(p)) += weight * hat * (couple * uv);
    });
  });
}

void LevelCouples::add(const Moments& moments, double* r) const {
  std::vector<Couple> couples(size());
  for (std::size_t c = 0; c < size(); ++c) couples[c] = couples_.normal(c) * moments[c].transpose();
  add(couples, r);
}

Couple LevelCouples::slopes(std::size_t c, const double* x) const {
  Couple out = Couple::Zero();
  const Index v = couples_.normals_[c].vertex;
  const Eigen::Map<const Vec3> own(x + 3 * std::size_t(v));
  std::size_t k = couples_.first_row_[c];
  if (couples_.on_border(c)) {
    for (const Spoke& spoke : grid_.mesh().ring(v)) {
      const auto step = [&](int i) -> Vec3 {
        const Index p = grid_.edge_point(spoke.edge, spoke.outward ? i : grid_.n() - i);
        return Eigen::Map<const Vec3>(x + 3 * std::size_t(p)) - own;
      };
      out += (2 * step(1) - 0.5 * step(2)) * couples_.rows_[k++].transpose();
    }
    return grid_.n() * out;
  }
  visit_ring(grid_, v, [&](Index p, std::size_t) {
    out += (Eigen::Map<const Vec3>(x + 3 * std::size_t(p)) - own) * couples_.rows_[k++].transpose();
  });
  return grid_.n() * out;
}

// The nearest normal that the border curve allows; elsewhere the given one.
Vec3 LevelCouples::goal(std::size_t c, const Couple& slopes) const {
  const Vec3& normal = couples_.normal(c);
  if (!couples_.on_border(c)) return normal;
  const Vec3 along = slopes.col(0).normalized();
  return (normal - along.dot(normal) * along).normalized();
}

double LevelCouples::angle(std::size_t c, const double* x) const {
  const Couple slope = slopes(c, x);
  const Vec3 own = slope.col(0).cross(slope.col(1));
  const Vec3 normal = goal(c, slope);
  return std::atan2(own.cross(normal).norm(), own.dot(normal));
}

Compliance LevelCouples::compliance(std::vector<Eigen::Matrix2d> slopes) const {
  for (std::size_t c = 0; c < slopes.size(); ++c) {
    Eigen::Matrix2d& slope = slopes[c];
    if (couples_.on_border(c)) slope(0, 0) = slope(1, 1);  // no couple turns the curve
    const double mean = 0.5 * slope.trace();
    // a weak direction is ignored if its slope is within the error of the solves
    if (!(slope.determinant() > coarse_force_tolerance * mean * mean))
      slope = (mean > 0 ? mean : slope.norm()) * Eigen::Matrix2d::Identity();
  }
  return {std::move(slopes), total_};
}

Moments LevelCouples::correction(const Compliance& compliance, const double* x) const {
  Moments out(size(), Vec2::Zero());
  couples_.workers_.for_each(size(), vertex_grain, [&](std::size_t c) {
    if (!(compliance.slopes[c].trace() > 0) || !(total_[c] > 0)) return;
    const Eigen::Matrix2d made = total_[c] / compliance.totals[c] * compliance.slopes[c];
    const Couple slope = slopes(c, x);
    out[c] = -(made.inverse() * (slope.transpose() * goal(c, slope)));
  });
  return out;
}

void LevelCouples::carry(const LevelCouples& from, Moments& moments) const {
  for (std::size_t c = 0; c < size(); ++c)
    if (total_[c] > 0) moments[c] *= from.total_[c] / total_[c];
}

std::vector<std::vector<std::size_t>> Couples::sets_apart() const {
  std::vector<std::vector<std::size_t>> sets;
  std::vector<std::int64_t> set_of(std::size_t(mesh_.vertex_count()), -1);
  std::vector<std::size_t> taken;  // per set: the normal that uses it, counted from one
  for (const std::size_t c : Cancellable(size())) {
    const Index v = normals_[c].vertex;
    const auto mark = [&](Index w) {
      const std::int64_t set = set_of[w];
      if (set >= 0) taken[set] = c + 1;
    };
    for (const Spoke& spoke : mesh_.ring(v)) {
      const Index w = mesh_.end_of(spoke);
      mark(w);
      for (const Spoke& next : mesh_.ring(w)) mark(mesh_.end_of(next));
    }
    const std::size_t set = std::size_t(
        std::find_if(taken.begin(), taken.end(), [&](std::size_t by) { return by != c + 1; }) -
        taken.begin());
    if (set == sets.size()) {
      sets.emplace_back();
      taken.push_back(0);
    }
    sets[set].push_back(c);
    set_of[v] = std::int64_t(set);
  }
  return sets;
}

}  // namespace fairing
