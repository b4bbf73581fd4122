// SPDX-License-Identifier: GPL-3.0-or-later
#include "splines/patch_data.h"

#include <algorithm>
#include <cmath>
#include <span>

namespace fairing {
namespace {

SplineCurve part_of(const SplineCurve& curve, const PatchSide& side) {
  SplineCurve out = part_of(curve, side.from, side.to, side.all);
  return side.reversed ? reversed(std::move(out)) : out;
}

// The normals of a smooth curve on the side. Where spans are shorter than the lattice's steps,
// there are additional ones between, since neighbours have to agree there too.
std::vector<SideNormal> side_normals(const FittedCurve& curve, const PatchSide& side) {
  std::vector<SideNormal> out;
  const auto add = [&](double at, const Vec3& normal, double weight) {
    const double t = on_side(side, at);
    if (t >= 0 && t <= 1) out.push_back({t, normal, weight});
  };
  for (std::size_t k = 0; k < curve.normals.size(); ++k) {
    add(curve.parameters[k], curve.normals[k], 1);
    if (k + 1 == curve.normals.size()) break;
    const double from = curve.parameters[k], width = curve.parameters[k + 1] - from;
    const int parts = int(std::ceil(width * steps_a_span * most_spans));  // as dense as samples
    for (int part = 1; part < parts; ++part) {
      const double at = from + width * part / parts;
      add(at, normal_at(curve, at), 1.0 / parts);
    }
  }
  return out;
}

// The parameters on a curve of evenly spaced points along a side of the lattice. Blended from side
// to side, they are the start of a patch's samples.
class SideMap {
 public:
  SideMap(const FittedCurve& curve, const PatchSide& side) : curve_(curve), side_(side) {
    from_ = on_side(side, curve_at(on_curve(side, 0)));
    to_ = on_side(side, curve_at(on_curve(side, 1)));
  }
  double operator()(double t) const {
    return std::clamp((on_side(side_, curve_at(on_curve(side_, t))) - from_) / (to_ - from_), 0.0,
                      1.0);
  }

 private:
  double curve_at(double even) const {
    const std::size_t last = curve_.parameters.size() - 1;
    const double x = even * double(last);
    const std::size_t k = std::min(std::size_t(x), last - 1);
    const double share = x - double(k);
    return (1 - share) * curve_.parameters[k] + share * curve_.parameters[k + 1];
  }

  const FittedCurve& curve_;
  const PatchSide& side_;
  double from_ = 0, to_ = 1;
};

std::size_t index_of(const Sheet& sheet, GridPoint p) {
  return std::size_t(p.j) * std::size_t(sheet.width() + 1) + std::size_t(p.i);
}

// For all points of quads, row by row: the share of the row's length before the point, or with
// `upward` of the column's.
std::vector<double> length_shares(const Sheet& sheet, bool upward) {
  const int lines = upward ? sheet.width() : sheet.height(),
            n = upward ? sheet.height() : sheet.width();
  const auto spot = [&](int line, int k) {
    return upward ? GridPoint{line, k} : GridPoint{k, line};
  };
  std::vector<double> out(std::size_t(lines + 1) * std::size_t(n + 1));
  for (int line = 0; line <= lines; ++line) {
    std::vector<double> before{0.0};
    for (int k = 1; k <= n; ++k)
      before.push_back(before.back() +
                       (sheet.position(spot(line, k)) - sheet.position(spot(line, k - 1))).norm());
    for (int k = 0; k <= n; ++k)
      out[index_of(sheet, spot(line, k))] =
          before.back() > 0 ? before[k] / before.back() : double(k) / n;
  }
  return out;
}

// The parameter of a side's curve at a share of the side's length.
double at_share(const SideMap& map, std::span<const double> shares, double share) {
  const auto after = std::upper_bound(shares.begin() + 1, shares.end() - 1, share);
  const auto k = after - shares.begin();
  const double from = shares[k - 1], width = *after - from;
  const double even = double(k - 1) + (width > 0 ? (share - from) / width : 0.0);
  return map(std::clamp(even / double(shares.size() - 1), 0.0, 1.0));
}

// The shares of length_shares along a line.
std::vector<double> line_of(const std::vector<double>& shares, const Sheet& sheet, GridPoint from,
                            GridPoint step) {
  std::vector<double> out;
  for (GridPoint p = from; sheet.inside(p); p = {p.i + step.i, p.j + step.j})
    out.push_back(shares[index_of(sheet, p)]);
  return out;
}

// Steps between points on a line of the lattice with so many steps a face's patch: with more points
// than all its spans need nothing is found that is not found between these.
int stride_of(int steps) { return std::max(1, steps / (steps_a_span * most_spans)); }

// The inner points of quads, at even parameters.
template <class Visit>
void for_quad_points(const Sheet& sheet, Visit&& visit) {
  const int stride = stride_of(sheet.lattice().n());
  for (int j = stride; j < sheet.height(); j += stride)
    for (int i = stride; i < sheet.width(); i += stride)
      visit(GridPoint{i, j}, double(i) / sheet.width(), double(j) / sheet.height(), i, j);
}

// The part of a triangle next to a corner, with the parameters of the bilinear map.
template <class Visit>
void for_third_points(int n, int corner, Visit&& visit) {
  const int stride = stride_of(n / 2);
  for (int r = stride; r < n; r += stride)
    for (int k = stride; k < n - r; k += stride) {
      const int own = n - k - r;
      if (own <= k || own <= r) continue;
      const double a = double(k) / n, b = double(r) / n, rest = 3 - 2 * (a - b);
      const double v = (rest - std::sqrt(rest * rest - 24 * b)) / 2, u = v + 2 * (a - b);
      visit(closed_point(false, n, corner, k, r), u, v, k, r);
    }
}

template <class Visit>
void for_points(const Sheet& sheet, int corner, Visit&& visit) {
  if (corner < 0)
    for_quad_points(sheet, visit);
  else
    for_third_points(sheet.width(), corner, visit);
}

}  // namespace

double on_curve(const PatchSide& side, double t) {
  const double along = side.reversed ? 1 - t : t;
  return (side.from + along * (side.to - side.from)) / side.all;
}

double on_side(const PatchSide& side, double t) {
  const double along = (t * side.all - side.from) / (side.to - side.from);
  return side.reversed ? 1 - along : along;
}

PatchData patch_data(const Lattice& lattice, const Topology& topology, const PatchPlace& place,
                     const std::vector<FittedCurve>& curves) {
  PatchData out;
  out.size = lattice.size();
  out.own = true;
  for (std::size_t s = 0; s < 4; ++s) {
    const PatchSide& side = place.side[s];
    const FittedCurve& curve = curves[side.curve];
    out.side[s] = part_of(curve.curve, side);
    out.normals[s] = side_normals(curve, side);
    out.own &= curve.own;
  }
  const auto map = [&](std::size_t s) {
    return SideMap(curves[place.side[s].curve], place.side[s]);
  };
  const SideMap below = map(0), right = map(1), above = map(2), left = map(3);
  const Sheet sheet(lattice, place.grid);
  std::vector<double> share_u, share_v;
  std::array<std::vector<double>, 4> line;
  const bool by_length = place.corner < 0 && !out.own;
  if (by_length) {
    share_u = length_shares(sheet, false);
    share_v = length_shares(sheet, true);
    line = {line_of(share_u, sheet, {0, 0}, {1, 0}),
            line_of(share_v, sheet, {sheet.width(), 0}, {0, 1}),
            line_of(share_u, sheet, {0, sheet.height()}, {1, 0}),
            line_of(share_v, sheet, {0, 0}, {0, 1})};
  }
  for_points(sheet, place.corner, [&](GridPoint p, double u, double v, int, int) {
    const Vec3 normal = area_normal(sheet, p);
    const Sheet::Spot spot = sheet.spot(p);
    const bool tip = in_tip(lattice, topology, spot.face, spot.at);
    PatchSample sample{.at = sheet.position(p),
                       .normal = tip ? Vec3(Vec3::Zero()) : normal.normalized(),
                       .u = (1 - v) * below(u) + v * above(u),
                       .v = (1 - u) * left(v) + u * right(v),
                       .area = normal.norm(),
                       .place = sheet.place(p),
                       .fitted = true};
    if (by_length) {
      const double a = share_u[index_of(sheet, p)], b = share_v[index_of(sheet, p)];
      sample.u = (1 - b) * at_share(below, line[0], a) + b * at_share(above, line[2], a);
      sample.v = (1 - a) * at_share(left, line[3], b) + a * at_share(right, line[1], b);
    }
    out.samples.push_back(sample);
  });
  return out;
}

void choose_fitted(const Lattice& lattice, const PatchPlace& place, int spans_u, int spans_v,
                   PatchData& data) {
  const Sheet sheet(lattice, place.grid);
  const auto stride = [&](int steps, int spans) {
    if (place.corner >= 0) steps /= 2;
    return std::max(1, steps / (steps_a_span * std::max(2, spans)));
  };
  const int u = stride(sheet.width(), spans_u), v = stride(sheet.height(), spans_v);
  std::size_t k = 0;
  for_points(sheet, place.corner, [&](GridPoint, double, double, int i, int j) {
    data.samples[k++].fitted = i % u == 0 && j % v == 0;
  });
}

}  // namespace fairing
