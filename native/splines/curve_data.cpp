// SPDX-License-Identifier: GPL-3.0-or-later
#include "splines/curve_data.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/angle.h"

namespace fairing {
namespace {

// How far around a point normals are fitted to, in steps of the lattice.
constexpr int reach = 3;
// Creases that leave the fitted tangent plane by more (its sine) are not in one: the surface has a
// kink at their vertex, as where straight boundary edges meet at a corner.
constexpr double off_plane = 2 * collinear;

// Lagrange's weights at x of `count` nodes from `first` on, one apart.
std::vector<double> interpolation(double x, int first, int count) {
  std::vector<double> weights(std::size_t(count), 1.0);
  for (int a = 0; a < count; ++a)
    for (int b = 0; b < count; ++b)
      if (a != b) weights[std::size_t(a)] *= (x - first - b) / double(a - b);
  return weights;
}

}  // namespace

int CurveSource::samples() const { return std::min(lattice_.n(), steps_a_span * most_spans); }

std::vector<Vec3> CurveSource::edge_points(Index e) const {
  const SideUse& use = topology_.edges[std::size_t(e)].uses.front();
  const int stride = lattice_.n() / samples();
  std::vector<Vec3> out;
  for (int k = 0; k <= lattice_.n(); k += stride)
    out.push_back(lattice_.position(lattice_.point(use.face, use.side, k, 0)));
  return out;
}

CurveData CurveSource::sharp_edge(Index e) const {
  return {edge_points(e), {}, topology_.edges[std::size_t(e)].halved};
}

Vec3 CurveSource::edge_normal(const ControlEdge& edge, int k) const {
  const int n = lattice_.n();
  std::vector<Vec3> nearby;
  Vec3 guess = Vec3::Zero(), centre = Vec3::Zero();
  for (const SideUse& use : edge.uses) {
    const int from = use.reversed ? n - k : k;
    const bool quad = lattice_.quad(use.face);
    centre = lattice_.position(lattice_.point(use.face, use.side, from, 0));
    guess += lattice_normal(lattice_, use.face, closed_point(quad, n, use.side, from, 0));
    for (int r = &use == &edge.uses.front() ? 0 : 1; r <= reach; ++r)
      for (int at = std::max(0, from - reach); at <= std::min(quad ? n : n - r, from + reach); ++at)
        nearby.push_back(lattice_.position(lattice_.point(use.face, use.side, at, r)));
  }
  return fitted_normal(centre, nearby, guess.normalized());
}

CurveData CurveSource::smooth_edge(Index e, const std::vector<Vec3>& sector_normals) const {
  const ControlEdge& edge = topology_.edges[std::size_t(e)];
  CurveData out{edge_points(e), {}, edge.halved};
  const int n = lattice_.n(), stride = n / samples();
  const auto kink = [&](std::size_t end) {
    return topology_.kinks[std::size_t(edge.sectors[end])] != Kink::none;
  };
  for (const std::size_t end : {0u, 1u}) out.corner[end] = narrowest_angle(e, end == 1);
  for (int k = 0; k <= n; k += stride) {
    if ((k < steps_a_span && kink(0)) || (n - k < steps_a_span && kink(1)))
      out.normals.push_back(Vec3::Zero());
    else if (k > 0 && k < n)
      out.normals.push_back(edge_normal(edge, k));
    else
      out.normals.push_back(sector_normals[std::size_t(edge.sectors[k ? 1 : 0])]);
  }
  return out;
}

void CurveSource::add_crease_tangent(Index f, int s, bool at_end,
                                     const std::vector<FittedCurve>* curves,
                                     std::vector<Vec3>& tangents) const {
  const Index e = topology_.face_edges[std::size_t(f)][std::size_t(s)];
  const ControlEdge& edge = topology_.edges[std::size_t(e)];
  if (edge.kind == EdgeKind::smooth) return;
  bool back = false;
  for (const SideUse& use : edge.uses)
    if (use.face == f && use.side == s) back = use.reversed;
  const bool from_end = at_end != back;
  const Vec3 tangent =
      curves
          ? (*curves)[std::size_t(e)].curve.at(from_end ? 1.0 : 0.0).tangent * (from_end ? -1 : 1)
          : end_tangent(edge.uses.front().face, edge.uses.front().side, from_end);
  tangents.push_back(tangent.normalized());
}

// Away from an end of a side of the lattice: that of the cubic through its first points.
Vec3 CurveSource::end_tangent(Index f, int s, bool at_end) const {
  const auto at = [&](int k) {
    return lattice_.position(lattice_.point(f, s, at_end ? lattice_.n() - k : k, 0));
  };
  return -11 * at(0) + 18 * at(1) - 9 * at(2) + 2 * at(3);
}

// Between an edge and the next ones around one of its ends.
double CurveSource::narrowest_angle(Index e, bool at_end) const {
  const std::vector<SideUse>& uses = topology_.edges[std::size_t(e)].uses;
  const Vec3 own = end_tangent(uses.front().face, uses.front().side, at_end);
  double narrowest = std::numbers::pi;
  for (const SideUse& use : uses) {
    const int corners = lattice_.corners(use.face);
    const bool at_next = at_end != use.reversed;
    const int s = (use.side + (at_next ? 1 : corners - 1)) % corners;
    narrowest = std::min(narrowest, angle_between(own, end_tangent(use.face, s, !at_next)));
  }
  return narrowest;
}

std::vector<Kink> CurveSource::kinks(double least) const {
  std::vector<Kink> out;
  for (std::size_t s = 0; s < topology_.sectors.size(); ++s) {
    const Vec3 normal = sector_normal(Index(s), nullptr);
    const std::vector<Vec3> tangents = crease_tangents(Index(s), nullptr);
    const bool runs_through = tangents.size() == 2 && tangents[0].dot(tangents[1]) < 0;
    const bool is_tip =
        tangents.size() == 2 && std::ranges::any_of(topology_.sectors[s], [&](auto& at) {
          const GridPoint corner = closed_point(lattice_.quad(at.i), lattice_.n(), at.j, 0, 0);
          return lattice_normal(lattice_, at.i, corner).cross(normal).norm() > off_plane;
        });
    if (normal.isZero() || is_tip)
      out.push_back(Kink::sharp);
    else if (runs_through && std::abs(normal.dot(tangents[0] + tangents[1])) > least)
      out.push_back(Kink::slight);
    else
      out.push_back(Kink::none);
  }
  return out;
}

std::vector<Vec3> CurveSource::crease_tangents(Index sector,
                                               const std::vector<FittedCurve>* curves) const {
  std::vector<Vec3> out;
  for (const auto& [f, c] : topology_.sectors[std::size_t(sector)]) {
    const int corners = lattice_.corners(f);
    add_crease_tangent(f, c, false, curves, out);
    add_crease_tangent(f, (c + corners - 1) % corners, true, curves, out);
  }
  return out;
}

Vec3 CurveSource::sector_normal(Index sector, const std::vector<FittedCurve>* curves) const {
  std::vector<Vec3> nearby;
  Vec3 guess = Vec3::Zero(), centre = Vec3::Zero();
  const int n = lattice_.n();
  for (const auto& [f, c] : topology_.sectors[std::size_t(sector)]) {
    const bool quad = lattice_.quad(f);
    const int rows = quad ? reach : reach + 1;
    for (int r = 0; r <= rows; ++r)
      for (int k = 0; k <= (quad ? rows : rows - r); ++k)
        if (k + r > 0) nearby.push_back(lattice_.position(lattice_.point(f, c, k, r)));
    centre = lattice_.position(lattice_.point(f, c, 0, 0));
    guess += lattice_normal(lattice_, f, closed_point(quad, n, c, 0, 0));
  }
  const Vec3 normal = fitted_normal(centre, nearby, guess.normalized());
  const std::vector<Vec3> tangents = crease_tangents(sector, curves);
  if (tangents.empty()) return normal;
  if (tangents.size() == 2) {
    const Vec3 both = tangents[0].cross(tangents[1]);
    const double along = both.normalized().dot(normal);
    // collinear creases do not span a plane
    if (both.norm() > collinear && std::abs(along) > std::sqrt(1 - off_plane * off_plane))
      return both.normalized() * (along < 0 ? -1.0 : 1.0);
    if (both.norm() > collinear) return Vec3::Zero();
  }
  if (std::abs(normal.dot(tangents.front())) > off_plane) return Vec3::Zero();
  return across(normal, tangents.front());
}

// The median of side s has lattice points in every other row.
Vec3 CurveSource::on_median(Index f, int s, double row) const {
  const int n = lattice_.n(), nodes = n / 2 + 1, count = std::min(6, nodes);
  const int first = std::clamp(int(row / 2) - count / 2 + 1, 0, nodes - count);
  const std::vector<double> weights = interpolation(row / 2, first, count);
  Vec3 out = Vec3::Zero();
  for (int a = 0; a < count; ++a) {
    const int r = 2 * (first + a);
    out += weights[std::size_t(a)] * lattice_.position(lattice_.point(f, s, (n - r) / 2, r));
  }
  return out;
}

Vec3 CurveSource::centroid(Index f) const {
  const double row = lattice_.n() / 3.0;
  return (on_median(f, 0, row) + on_median(f, 1, row) + on_median(f, 2, row)) / 3.0;
}

Vec3 CurveSource::normal_inside(Index f, double i, double j, const Vec3& at) const {
  const int n = lattice_.n(), low_i = std::max(0, int(std::ceil(i)) - reach),
            low_j = std::max(0, int(std::ceil(j)) - reach);
  std::vector<Vec3> nearby;
  for (int b = low_j; b <= std::min(n, int(j) + reach); ++b)
    for (int a = low_i; a <= std::min(n - b, int(i) + reach); ++a)
      nearby.push_back(lattice_.position(f, {a, b}));
  const int near_i = std::min(int(std::lround(i)), n);
  return fitted_normal(
      at, nearby, lattice_normal(lattice_, f, {near_i, std::min(int(std::lround(j)), n - near_i)}));
}

CurveData CurveSource::inner(Index f, int s, const FittedCurve& edge) const {
  const int n = lattice_.n(), count = std::max(8, samples() / 2);
  CurveData out;
  for (int k = 0; k <= count; ++k) {
    const double row = n / 3.0 * k / count, beside = (n - row) / 2;
    out.points.push_back(k < count ? on_median(f, s, row) : centroid(f));
    std::array<double, 3> from_corner;  // barycentric, times n
    from_corner[std::size_t(s)] = from_corner[std::size_t((s + 1) % 3)] = beside;
    from_corner[std::size_t((s + 2) % 3)] = row;
    out.normals.push_back(normal_inside(f, from_corner[1], from_corner[2], out.points.back()));
  }
  // Patches start at the curve itself, not at the lattice's point.
  const CurvePoint middle = edge.curve.at(0.5);
  out.points.front() = middle.at;
  if (!edge.normals.empty()) out.normals.front() = normal_at(edge, 0.5);
  const Vec3 turned = across(out.normals.front(), middle.tangent.normalized());
  if (!turned.isZero()) out.normals.front() = turned;
  return out;
}

}  // namespace fairing
