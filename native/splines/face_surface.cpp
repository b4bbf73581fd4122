// SPDX-License-Identifier: GPL-3.0-or-later
#include "splines/face_surface.h"

#include <algorithm>
#include <cmath>

namespace fairing {

// The derivative along a direction, of second order also at the sides; false if there are too few
// points in that direction.
bool FaceSurface::slope(GridPoint p, int di, int dj, Vec3& out) const {
  const auto inside = [&](int k) { return sheet_.inside({p.i + k * di, p.j + k * dj}); };
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

// Next to a triangle's corners there are points along two of three directions only.
Vec3 FaceSurface::normal_at(GridPoint p) const {
  const Sheet::Spot spot = sheet_.spot(p);
  if (in_tip(sheet_.lattice(), topology_, spot.face, spot.at)) return Vec3::Zero();
  Vec3 u, v, w;
  const bool along_u = slope(p, 1, 0, u), along_v = slope(p, 0, 1, v);
  if (along_u && along_v) return u.cross(v).normalized();
  slope(p, -1, 1, w);
  return (along_u ? u.cross(w) : v.cross(w)).normalized();
}

FaceSurface::Foot FaceSurface::foot_in_quad(const Vec3& point, double i, double j) const {
  const int a = std::clamp(int(std::floor(i)), 0, sheet_.width() - 1),
            b = std::clamp(int(std::floor(j)), 0, sheet_.height() - 1);
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
  const int last = sheet_.width() - 1, a = std::clamp(int(std::floor(i)), 0, last),
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

FaceSurface::Off FaceSurface::height(const Vec3& point, int corner, double u, double v,
                                     std::span<const double> least) const {
  const double n = sheet_.lattice().n();
  double i = sheet_.width() * u, j = sheet_.height() * v;
  if (corner >= 0) {  // the bilinear map of a third, from its corner
    const double k = n * u * (3 - v) / 6, r = n * v * (3 - u) / 6, rest = n - k - r;
    i = corner == 0 ? k : corner == 1 ? rest : r;
    j = corner == 0 ? r : corner == 1 ? k : rest;
  }
  Foot foot{};
  for (int cell = 0; cell < sheet_.width() + sheet_.height(); ++cell) {  // on the way to the foot
    foot = sheet_.quads() ? foot_in_quad(point, i, j) : foot_in_triangle(point, i, j);
    const double moved = std::max(std::abs(foot.i - i), std::abs(foot.j - j));
    i = std::clamp(foot.i, 0.0, double(sheet_.width()));
    j = std::clamp(foot.j, 0.0, double(sheet_.height()));
    if (moved < 1) break;
  }
  const int place = sheet_.place(foot.corner[0]);
  Vec3 flat = point;
  for (std::size_t k = 0; k < 4; ++k) flat -= foot.share[k] * sheet_.position(foot.corner[k]);
  if (flat.norm() <= least[place]) return {0, place};
  Vec3 normal = Vec3::Zero();
  double above = 0;
  for (std::size_t k = 0; k < 4; ++k) {
    if (foot.share[k] == 0) continue;
    const Vec3 own = normal_at(foot.corner[k]);
    if (own.isZero()) return {flat.norm(), place};
    above += foot.share[k] * (point - sheet_.position(foot.corner[k])).dot(own);
    normal += foot.share[k] * own;
  }
  const double off = flat.dot(normal.normalized());
  return {off * above <= 0 ? 0 : std::min(std::abs(off), std::abs(above)), place};
}

}  // namespace fairing
