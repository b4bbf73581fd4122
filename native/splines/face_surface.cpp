// SPDX-License-Identifier: GPL-3.0-or-later
#include "splines/face_surface.h"

#include <algorithm>
#include <cmath>

namespace fairing {
namespace {

// From cell to cell towards the foot.
constexpr int most_steps = 8;

struct Step {
  double s, t;
};

// To where `rest` is least, along the directions u and v.
Step least_squares(const Vec3& rest, const Vec3& u, const Vec3& v) {
  const double uu = u.squaredNorm(), uv = u.dot(v), vv = v.squaredNorm(), det = uu * vv - uv * uv;
  if (!(det > 1e-12 * uu * vv)) return {0, 0};
  const double ru = rest.dot(u), rv = rest.dot(v);
  return {(vv * ru - uv * rv) / det, (uu * rv - uv * ru) / det};
}

}  // namespace

FaceSurface::FaceSurface(const Lattice& lattice, const Topology& topology, Index f)
    : n_(lattice.n()), quad_(lattice.quad(f)) {
  const auto for_each = [&](auto&& visit) {
    for (int j = 0; j <= n_; ++j)
      for (int i = 0; i <= (quad_ ? n_ : n_ - j); ++i) visit(GridPoint{i, j});
  };
  at_.reserve(closed_size(quad_, std::size_t(n_)));
  normal_.reserve(at_.capacity());
  for_each([&](GridPoint p) { at_.push_back(lattice.position(f, p)); });
  for_each([&](GridPoint p) {
    normal_.push_back(in_tip(lattice, topology, f, p) ? Vec3(Vec3::Zero()) : normal_at(p));
  });
}

// The derivative along a direction, of second order also at the sides; false where too few points
// lie that way.
bool FaceSurface::slope(GridPoint p, int di, int dj, Vec3& out) const {
  const auto inside = [&](int k) {
    const int i = p.i + k * di, j = p.j + k * dj;
    return i >= 0 && j >= 0 && (quad_ ? i <= n_ && j <= n_ : i + j <= n_);
  };
  const auto at = [&](int k) -> const Vec3& { return at_[index(p.i + k * di, p.j + k * dj)]; };
  if (inside(1) && inside(-1))
    out = (at(1) - at(-1)) / 2;
  else if (inside(2))
    out = (4 * at(1) - at(2) - 3 * at(0)) / 2;
  else if (inside(-2))
    out = (3 * at(0) - 4 * at(-1) + at(-2)) / 2;
  else
    return false;
  return true;
}

// Next to a triangle's corners points lie along two of three directions only.
Vec3 FaceSurface::normal_at(GridPoint p) const {
  Vec3 u, v, w;
  const bool along_u = slope(p, 1, 0, u), along_v = slope(p, 0, 1, v);
  if (along_u && along_v) return u.cross(v).normalized();
  slope(p, -1, 1, w);
  return (along_u ? u.cross(w) : v.cross(w)).normalized();
}

FaceSurface::Foot FaceSurface::foot_in_quad(const Vec3& point, double i, double j) const {
  const int a = std::clamp(int(std::floor(i)), 0, n_ - 1),
            b = std::clamp(int(std::floor(j)), 0, n_ - 1);
  Foot out;
  out.corner = {index(a, b), index(a + 1, b), index(a, b + 1), index(a + 1, b + 1)};
  const Vec3 &p = at_[out.corner[0]], u = at_[out.corner[1]] - p, v = at_[out.corner[2]] - p,
             twist = at_[out.corner[3]] - p - u - v;
  double s = i - a, t = j - b;
  for (int round = 0; round < 2; ++round) {  // a cell is almost a parallelogram
    const Step step =
        least_squares(point - p - s * u - t * v - s * t * twist, u + t * twist, v + s * twist);
    s += step.s;
    t += step.t;
  }
  out.share = {(1 - s) * (1 - t), s * (1 - t), (1 - s) * t, s * t};
  out.i = a + s;
  out.j = b + t;
  return out;
}

FaceSurface::Foot FaceSurface::foot_in_triangle(const Vec3& point, double i, double j) const {
  const int a = std::clamp(int(std::floor(i)), 0, n_ - 1),
            b = std::clamp(int(std::floor(j)), 0, n_ - 1 - a);
  const bool upper = i - a + j - b > 1 && a + b + 2 <= n_;
  const int way = upper ? -1 : 1, c = a + upper, d = b + upper;
  Foot out;
  out.corner = {index(c, d), index(c + way, d), index(c, d + way), index(c, d)};
  const Vec3& p = at_[out.corner[0]];
  const auto [s, t] = least_squares(point - p, at_[out.corner[1]] - p, at_[out.corner[2]] - p);
  out.share = {1 - s - t, s, t, 0};
  out.i = c + way * s;
  out.j = d + way * t;
  return out;
}

double FaceSurface::height(const Vec3& point, int corner, double u, double v) const {
  double i = n_ * u, j = n_ * v;
  if (corner >= 0) {  // the bilinear map of a third, from its corner
    const double k = n_ * u * (3 - v) / 6, r = n_ * v * (3 - u) / 6, rest = n_ - k - r;
    i = corner == 0 ? k : corner == 1 ? rest : r;
    j = corner == 0 ? r : corner == 1 ? k : rest;
  }
  Foot foot{};
  for (int step = 0; step < most_steps; ++step) {
    foot = quad_ ? foot_in_quad(point, i, j) : foot_in_triangle(point, i, j);
    const double moved = std::max(std::abs(foot.i - i), std::abs(foot.j - j));
    i = std::clamp(foot.i, 0.0, double(n_));
    j = std::clamp(foot.j, 0.0, double(n_));
    if (moved < 1) break;
  }
  Vec3 flat = Vec3::Zero(), normal = Vec3::Zero();
  double above = 0;
  bool tip = false;
  for (std::size_t k = 0; k < 4; ++k) {
    if (foot.share[k] == 0) continue;
    const Vec3 arm = foot.share[k] * (point - at_[foot.corner[k]]);
    const Vec3& own = normal_[foot.corner[k]];
    flat += arm;
    above += arm.dot(own);
    normal += foot.share[k] * own;
    tip = tip || own.isZero();
  }
  if (tip) return flat.norm();
  const double off = flat.dot(normal.normalized());
  return off * above <= 0 ? 0 : std::min(std::abs(off), std::abs(above));
}

}  // namespace fairing
