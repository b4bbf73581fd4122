// SPDX-License-Identifier: GPL-3.0-or-later
#include "splines/curve_data.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>

#include "base/angle.h"
#include "base/roundoff.h"

namespace fairing {
namespace {

// Distance, in steps of the lattice, of the points around a point to which its normal is fitted.
constexpr int reach = 3;
// Sine of the angle from which creases are not in the fitted tangent plane: the surface has a kink
// at their vertex, as where straight boundary edges meet at a corner.
constexpr double off_plane = 2 * collinear;

// Lagrange's weights at x of `count` nodes at unit distances from `first` on.
std::vector<double> interpolation(double x, int first, int count) {
  std::vector<double> weights(std::size_t(count), 1.0);
  for (int a = 0; a < count; ++a)
    for (int b = 0; b < count; ++b)
      if (a != b) weights[a] *= (x - first - b) / double(a - b);
  return weights;
}

// Appends the points of an edge to those of the edges before it; they share a point.
void append(std::vector<Vec3> more, bool backwards, std::vector<Vec3>& to) {
  if (backwards) std::reverse(more.begin(), more.end());
  to.insert(to.end(), more.begin() + (to.empty() ? 0 : 1), more.end());
}

// Whether all points are in the plane through `centre`, but for rounding.
bool in_plane(const Vec3& centre, std::span<const Vec3> points, const Vec3& normal) {
  return !normal.isZero() && std::ranges::all_of(points, [&](const Vec3& p) {
    const Vec3 arm = p - centre;
    return std::abs(arm.dot(normal)) <= single_roundoff * arm.norm();
  });
}

// Beside flats and straight strips curvature jumps, and a cubic through both sides is off. The
// straight lines that start at a point are exactly in its tangent plane.
class StraightLines {
 public:
  // Lines that turn by less than this angle from step to step are straight.
  explicit StraightLines(double straight) : straight_(straight) {}
  // The line from a point of the lattice along a side of a face, or into it.
  void add(const Lattice& lattice, Index f, int s, int k, int step_along, int step_inside) {
    const auto at = [&](int m) {
      return lattice.position(lattice.point(f, s, k + m * step_along, m * step_inside));
    };
    const Vec3 first = at(1) - at(0);
    for (int m = 1; m < reach; ++m)
      if (!(angle_between(first, at(m + 1) - at(m)) < straight_)) return;
    Vec3 direction = first.normalized();
    if (count_ == 1) direction -= direction.dot(line_[0]) * line_[0];
    if (count_ < 2 && direction.norm() > straight_) line_[count_++] = direction.normalized();
  }
  bool any() const { return count_ > 0; }
  // The unit vector across them that is nearest to a normal.
  Vec3 across(const Vec3& normal) const {
    Vec3 out = normal;
    for (std::size_t k = 0; k < count_; ++k) out -= out.dot(line_[k]) * line_[k];
    return out.norm() > off_plane ? Vec3(out.normalized()) : normal;
  }

 private:
  double straight_;
  std::array<Vec3, 2> line_;  // unit vectors, across each other
  std::size_t count_ = 0;
};

}  // namespace

int CurveSource::samples() const { return std::min(lattice_.n(), steps_a_span * most_spans); }

std::vector<Vec3> CurveSource::edge_points(Index e) const {
  const SideUse& use = topology_.edges[e].uses.front();
  const int stride = lattice_.n() / samples();
  std::vector<Vec3> out;
  for (int k = 0; k <= lattice_.n(); k += stride)
    out.push_back(lattice_.position(lattice_.point(use.face, use.side, k, 0)));
  return out;
}

CurveData CurveSource::sharp_chain(Index c) const {
  const EdgeChain& chain = topology_.chains[c];
  CurveData out;
  out.edges = int(chain.edges.size());
  for (std::size_t k = 0; k < chain.edges.size(); ++k)
    append(edge_points(chain.edges[k]), chain.reversed[k], out.points);
  // Sharp curves have the lattice's tangents at its ends; otherwise patches would bend there.
  const bool held = chain.kind != EdgeKind::smooth && out.edges > 1;
  for (const int cut : chain.cuts) {
    const bool inside = cut > 0 && cut < chain.halves();
    if (inside || held)
      out.cuts.push_back({std::size_t(cut * samples() / 2), double(cut) / chain.halves(),
                          held ? tangent_at(chain, cut / 2) : Vec3(Vec3::Zero())});
  }
  return out;
}

// Tangent of the line at a vertex of a chain.
Vec3 CurveSource::tangent_at(const EdgeChain& chain, int vertex) const {
  const auto at = std::size_t(std::max(0, vertex - 1));
  const bool at_end = vertex > 0;
  const SideUse& use = topology_.edges[chain.edges[at]].uses.front();
  return end_tangent(lattice_, use.face, use.side, at_end != bool(chain.reversed[at]));
}

Vec3 CurveSource::edge_normal(const ControlEdge& edge, int k) const {
  const int n = lattice_.n();
  NearbyPoints nearby;
  StraightLines lines(straight_);
  Vec3 guess = Vec3::Zero(), along = Vec3::Zero();
  for (const SideUse& use : edge.uses) {
    const int from = use.reversed ? n - k : k;
    const bool quad = lattice_.quad(use.face);
    const auto at = [&](int place, int r) {
      return lattice_.position(lattice_.point(use.face, use.side, place, r));
    };
    nearby.centre = at(from, 0);
    along = at(from + 1, 0) - at(from - 1, 0);
    for (int r = nearby.points.empty() ? 0 : 1; r <= reach; ++r)
      for (int place = std::max(0, from - reach); place <= std::min(quad ? n : n - r, from + reach);
           ++place)
        nearby.points.push_back(at(place, r));
    nearby.end_face();
    const Vec3 own = lattice_normal(lattice_, use.face, closed_point(quad, n, use.side, from, 0));
    if (in_plane(nearby.centre, nearby.last_face(), own)) return own;
    guess += own;
    if (quad || from + reach <= n) lines.add(lattice_, use.face, use.side, from, 0, 1);
  }
  const CurvatureJump jump{lines.any(), along.normalized()};
  return lines.across(fitted_normal(nearby, guess.normalized(), jump));
}

std::vector<Vec3> CurveSource::edge_normals(Index e,
                                            const std::vector<Vec3>& sector_normals) const {
  const ControlEdge& edge = topology_.edges[e];
  std::vector<Vec3> out;
  const int n = lattice_.n(), stride = n / samples();
  const auto kink = [&](std::size_t end) {
    return topology_.kinks[edge.sectors[end]] != Kink::none;
  };
  for (int k = 0; k <= n; k += stride) {
    if ((k < steps_a_span && kink(0)) || (n - k < steps_a_span && kink(1)))
      out.push_back(Vec3::Zero());
    else if (k > 0 && k < n)
      out.push_back(edge_normal(edge, k));
    else
      out.push_back(sector_normals[edge.sectors[k ? 1 : 0]]);
  }
  return out;
}

CurveData CurveSource::smooth_chain(Index c, const std::vector<Vec3>& sector_normals) const {
  const EdgeChain& chain = topology_.chains[c];
  CurveData out = sharp_chain(c);
  for (std::size_t k = 0; k < chain.edges.size(); ++k)
    append(edge_normals(chain.edges[k], sector_normals), chain.reversed[k], out.normals);
  out.corner = {narrowest_angle(chain.edges.front(), chain.reversed.front()),
                narrowest_angle(chain.edges.back(), !chain.reversed.back())};
  return out;
}

void CurveSource::add_crease_tangent(Index f, int s, bool at_end,
                                     const std::vector<FittedCurve>* curves,
                                     std::vector<Vec3>& tangents) const {
  const Index e = topology_.face_edges[f][s];
  const ControlEdge& edge = topology_.edges[e];
  if (edge.kind == EdgeKind::smooth) return;
  const bool from_end = at_end != topology_.runs_back({f, s});
  const auto fitted = [&] {
    const ChainPlace place = topology_.places[e];
    const bool back = topology_.chains[place.chain].reversed[place.at];
    const FittedCurve& curve = (*curves)[place.chain];
    const std::size_t k = std::size_t((place.at + (from_end != back)) * samples());
    return Vec3(curve.curve.at(curve.parameters[k]).tangent * (from_end != back ? -1 : 1));
  };
  const SideUse& use = edge.uses.front();
  const Vec3 tangent = curves ? fitted() : end_tangent(lattice_, use.face, use.side, from_end);
  tangents.push_back(tangent.normalized());
}

// The narrowest angle to adjacent edges at one of its ends.
double CurveSource::narrowest_angle(Index e, bool at_end) const {
  const std::vector<SideUse>& uses = topology_.edges[e].uses;
  const Vec3 own = end_tangent(lattice_, uses.front().face, uses.front().side, at_end);
  double narrowest = std::numbers::pi;
  for (const SideUse& use : uses) {
    const int corners = lattice_.corners(use.face);
    const bool at_next = at_end != use.reversed;
    const int s = (use.side + (at_next ? 1 : corners - 1)) % corners;
    narrowest =
        std::min(narrowest, angle_between(own, end_tangent(lattice_, use.face, s, !at_next)));
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
  for (const auto& [f, c] : topology_.sectors[sector]) {
    const int corners = lattice_.corners(f);
    add_crease_tangent(f, c, false, curves, out);
    add_crease_tangent(f, (c + corners - 1) % corners, true, curves, out);
  }
  return out;
}

Vec3 CurveSource::sector_normal(Index sector, const std::vector<FittedCurve>* curves) const {
  NearbyPoints nearby;
  StraightLines lines(straight_);
  Vec3 guess = Vec3::Zero(), flat = Vec3::Zero();
  const int n = lattice_.n();
  for (const auto& [f, c] : topology_.sectors[sector]) {
    const bool quad = lattice_.quad(f);
    const int rows = quad ? reach : reach + 1;
    for (int r = 0; r <= rows; ++r)
      for (int k = 0; k <= (quad ? rows : rows - r); ++k)
        if (k + r > 0) nearby.points.push_back(lattice_.position(lattice_.point(f, c, k, r)));
    nearby.end_face();
    nearby.centre = lattice_.position(lattice_.point(f, c, 0, 0));
    const Vec3 own = lattice_normal(lattice_, f, closed_point(quad, n, c, 0, 0));
    if (in_plane(nearby.centre, nearby.last_face(), own)) flat = own;
    guess += own;
    lines.add(lattice_, f, c, 0, 1, 0);
    lines.add(lattice_, f, c, 0, 0, 1);
  }
  const auto fitted = [&] {
    return lines.across(fitted_normal(nearby, guess.normalized(), {.jumps = lines.any()}));
  };
  const Vec3 normal = flat.isZero() ? fitted() : flat;
  const std::vector<Vec3> tangents = crease_tangents(sector, curves);
  if (tangents.empty()) return normal;
  if (tangents.size() == 2) {
    const Vec3 both = tangents[0].cross(tangents[1]);
    const double along = both.normalized().dot(normal);
    // collinear creases do not define a plane
    if (both.norm() > collinear && std::abs(along) > std::sqrt(1 - off_plane * off_plane))
      return both.normalized() * (along < 0 ? -1.0 : 1.0);
    if (both.norm() > collinear) return Vec3::Zero();
  }
  if (std::abs(normal.dot(tangents.front())) > off_plane) return Vec3::Zero();
  return across(normal, tangents.front());
}

// The median of side s contains lattice points in every other row.
Vec3 CurveSource::on_median(Index f, int s, double row) const {
  const int n = lattice_.n(), nodes = n / 2 + 1, count = std::min(6, nodes);
  const int first = std::clamp(int(row / 2) - count / 2 + 1, 0, nodes - count);
  const std::vector<double> weights = interpolation(row / 2, first, count);
  Vec3 out = Vec3::Zero();
  for (int a = 0; a < count; ++a) {
    const int r = 2 * (first + a);
    out += weights[a] * lattice_.position(lattice_.point(f, s, (n - r) / 2, r));
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
  NearbyPoints nearby{at, {}, {}};
  for (int b = low_j; b <= std::min(n, int(j) + reach); ++b)
    for (int a = low_i; a <= std::min(n - b, int(i) + reach); ++a)
      nearby.points.push_back(lattice_.position(f, {a, b}));
  nearby.end_face();
  const int near_i = std::min(int(std::lround(i)), n);
  return fitted_normal(
      nearby, lattice_normal(lattice_, f, {near_i, std::min(int(std::lround(j)), n - near_i)}));
}

CurveData CurveSource::inner(Index f, int s, const std::vector<FittedCurve>& curves) const {
  const FittedCurve& edge = curves[topology_.chain_of({f, s})];
  const int n = lattice_.n(), count = std::max(8, samples() / 2);
  CurveData out;
  for (int k = 0; k <= count; ++k) {
    const double row = n / 3.0 * k / count, beside = (n - row) / 2;
    out.points.push_back(k < count ? on_median(f, s, row) : centroid(f));
    std::array<double, 3> from_corner;  // barycentric, times n
    from_corner[s] = from_corner[(s + 1) % 3] = beside;
    from_corner[(s + 2) % 3] = row;
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
