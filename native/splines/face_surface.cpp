// SPDX-License-Identifier: GPL-3.0-or-later
#include "splines/face_surface.h"

#include <algorithm>
#include <cmath>

namespace fairing {

// The derivative along a direction, of second order also at the sides; false where too few points
// lie that way.
bool FaceSurface::slope(GridPoint p, int di, int dj, Vec3& out) const {
  const int n = lattice_.n();
  const auto inside = [&](int k) {
    const int i = p.i + k * di, j = p.j + k * dj;
    return i >= 0 && j >= 0 && (lattice_.quad(face_) ? i <= n && j <= n : i + j <= n);
  };
  const auto from = [&](int k) { return at(p.i + k * di, p.j + k * dj); };
  if (inside(1) && inside(-1))
    out = (from(1) - from(-1)) / 2;
  else if (inside(2))
    out = (4 * from(1) - from(2) - 3 * from(0)) / 2;
  else if (inside(-2))
    out = (3 * from(0) - 4 * from(-1) + from(-2)) / 2;
  else
    return false;
  return true;
}

// Next to a triangle's corners points lie along two of three directions only.
Vec3 FaceSurface::normal_at(GridPoint p) const {
  if (in_tip(lattice_, topology_, face_, p)) return Vec3::Zero();
  Vec3 u, v, w;
  const bool along_u = slope(p, 1, 0, u), along_v = slope(p, 0, 1, v);
  if (along_u && along_v) return u.cross(v).normalized();
  slope(p, -1, 1, w);
  return (along_u ? u.cross(w) : v.cross(w)).normalized();
}

FaceSurface::Foot FaceSurface::foot_in_quad(const Vec3& point, double i, double j) const {
  const int last = lattice_.n() - 1, a = std::clamp(int(std::floor(i)), 0, last),
            b = std::clamp(int(std::floor(j)), 0, last);
  Foot out;
  out.corner = {{{a, b}, {a + 1, b}, {a, b + 1}, {a + 1, b + 1}}};
  const Vec3 p = at(a, b), u = at(a + 1, b) - p, v = at(a, b + 1) - p,
             twist = at(a + 1, b + 1) - p - u - v;
  double s = i - a, t = j - b;
  for (int round = 0; round < 2; ++round) {  // a cell is almost a parallelogram
    const Slide step =
        slide_to(point - p - s * u - t * v - s * t * twist, u + t * twist, v + s * twist);
    s += step.along_u;
    t += step.along_v;
  }
  out.share = {(1 - s) * (1 - t), s * (1 - t), (1 - s) * t, s * t};
  out.i = a + s;
  out.j = b + t;
  return out;
}

FaceSurface::Foot FaceSurface::foot_in_triangle(const Vec3& point, double i, double j) const {
  const int last = lattice_.n() - 1, a = std::clamp(int(std::floor(i)), 0, last),
            b = std::clamp(int(std::floor(j)), 0, last - a);
  const bool upper = i - a + j - b > 1 && a + b < last;
  const int way = upper ? -1 : 1, c = a + upper, d = b + upper;
  Foot out;
  out.corner = {{{c, d}, {c + way, d}, {c, d + way}, {c, d}}};
  const Vec3 p = at(c, d);
  const auto [s, t] = slide_to(point - p, at(c + way, d) - p, at(c, d + way) - p);
  out.share = {1 - s - t, s, t, 0};
  out.i = c + way * s;
  out.j = d + way * t;
  return out;
}

double FaceSurface::height(const Vec3& point, int corner, double u, double v, double least) const {
  const double n = lattice_.n();
  double i = n * u, j = n * v;
  if (corner >= 0) {  // the bilinear map of a third, from its corner
    const double k = n * u * (3 - v) / 6, r = n * v * (3 - u) / 6, rest = n - k - r;
    i = corner == 0 ? k : corner == 1 ? rest : r;
    j = corner == 0 ? r : corner == 1 ? k : rest;
  }
  Foot foot{};
  for (int cell = 0; cell < lattice_.n(); ++cell) {  // on the way to the foot
    foot = lattice_.quad(face_) ? foot_in_quad(point, i, j) : foot_in_triangle(point, i, j);
    const double moved = std::max(std::abs(foot.i - i), std::abs(foot.j - j));
    i = std::clamp(foot.i, 0.0, n);
    j = std::clamp(foot.j, 0.0, n);
    if (moved < 1) break;
  }
  Vec3 flat = point;
  for (std::size_t k = 0; k < 4; ++k)
    flat -= foot.share[k] * lattice_.position(face_, foot.corner[k]);
  if (flat.norm() <= least) return 0;
  Vec3 normal = Vec3::Zero();
  double above = 0;
  for (std::size_t k = 0; k < 4; ++k) {
    if (foot.share[k] == 0) continue;
    const Vec3 own = normal_at(foot.corner[k]);
    if (own.isZero()) return flat.norm();
    above += foot.share[k] * (point - lattice_.position(face_, foot.corner[k])).dot(own);
    normal += foot.share[k] * own;
  }
  const double off = flat.dot(normal.normalized());
  return off * above <= 0 ? 0 : std::min(std::abs(off), std::abs(above));
}

}  // namespace fairing
