// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/fill/islands.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <set>

#include "base/points.h"
#include "mesh/fill/rims.h"
#include "mesh/sharp_turn.h"
#include "parallel/cancel.h"

namespace fairing {
namespace {

// A loop projected to its mean plane.
struct FlatLoop {
  std::vector<Vec3> points;
  Vec3 middle = Vec3::Zero(), normal = Vec3::Zero();  // normal of a face that fills it
  // reach: largest distance of a point from the centre
  double area = 0, reach = 0;
  // mean direction in which the faces at the rim continue, of length 1 at most
  Vec3 onward = Vec3::Zero();
  double outward = 0;  // its component away from the centre, in the plane

  FlatLoop(const HoleLoop& loop, const Rims& rims) {
    for (const std::int64_t v : loop) points.push_back(rims.point(v));
    for (const Vec3& p : points) middle += p / double(points.size());
    Vec3 twice_area = Vec3::Zero();
    for (std::size_t i = 0; i < points.size(); ++i)
      twice_area += (points[i] - middle).cross(next(i) - middle);
    area = twice_area.norm() / 2;
    normal = unit_or_zero(twice_area);
    double length = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
      const Vec3 side = next(i) - points[i];
      const Vec3 across = rims.normal_beside(loop[(i + 1) % loop.size()], loop[i]).cross(side);
      onward += across;
      outward += across.dot(unit_or_zero(in_plane((points[i] + next(i)) / 2 - middle)));
      length += side.norm();
      reach = std::max(reach, (points[i] - middle).norm());
    }
    if (length > 0) onward /= length, outward /= length;
  }

  Vec3 in_plane(const Vec3& v) const { return v - v.dot(normal) * normal; }

  // Whether a point is inside in the projection along the normal.
  bool contains(const Vec3& p) const {
    double turns = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
      const Vec3 a = in_plane(points[i] - p), b = in_plane(next(i) - p);
      turns += std::atan2(a.cross(b).dot(normal), a.dot(b));
    }
    return turns > std::acos(-1.0);  // once around
  }

 private:
  const Vec3& next(std::size_t i) const { return points[(i + 1) % points.size()]; }
};

// Whether the two nearest points are farther apart in the plane than along its normal.
bool is_beside(const FlatLoop& inner, const FlatLoop& rim) {
  double least = std::numeric_limits<double>::infinity();
  Vec3 way = Vec3::Zero();
  for (const Vec3& p : inner.points)
    for (const Vec3& q : rim.points)
      if (const double distance = (p - q).squaredNorm(); distance < least)
        least = distance, way = p - q;
  return rim.in_plane(way).norm() >= std::abs(way.dot(rim.normal));
}

bool is_island(const FlatLoop& inner, const FlatLoop& rim) {
  if (inner.area >= rim.area || inner.normal.dot(rim.normal) > -sharp_turn) return false;
  if ((inner.middle - rim.middle).norm() > rim.reach + inner.reach) return false;
  // faces at the rim must not lie in the hole, those at the island must not end at another island,
  // and they must not point away from each other
  if (rim.outward > sharp_turn || inner.outward < -sharp_turn) return false;
  if (std::min(rim.onward.dot(rim.normal), inner.onward.dot(rim.normal)) < -sharp_turn)
    return false;
  return std::all_of(inner.points.begin(), inner.points.end(),
                     [&](const Vec3& p) { return rim.contains(p); }) &&
         is_beside(inner, rim);
}

}  // namespace

std::vector<Hole> with_islands(const PolygonMesh& mesh, const HalfEdges& half_edges,
                               std::span<const Hole> single) {
  const Rims rims(mesh, half_edges, single);
  std::vector<FlatLoop> flat;
  for (const Hole& hole : single) flat.emplace_back(hole[0], rims);
  std::vector<std::size_t> order(single.size());  // ascending by size
  std::iota(order.begin(), order.end(), std::size_t(0));
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return flat[a].area < flat[b].area; });
  std::map<std::size_t, std::set<std::int64_t>> taken;  // vertices of a rim and its islands
  const auto touches = [&](std::size_t loop, std::size_t rim) {
    std::set<std::int64_t>& known = taken[rim];
    known.insert(single[rim][0].begin(), single[rim][0].end());
    const HoleLoop& ids = single[loop][0];
    return std::any_of(ids.begin(), ids.end(), [&](std::int64_t v) { return known.contains(v); });
  };
  constexpr std::size_t none = std::size_t(-1);
  std::vector<std::size_t> rim_of(single.size(), none);
  for (std::size_t at = order.size(); at-- > 0;) {
    stop_if_cancelled();
    for (std::size_t k = at + 1; k < order.size() && rim_of[order[at]] == none; ++k)
      if (const std::size_t loop = order[at], rim = order[k];
          rim_of[rim] == none && is_island(flat[loop], flat[rim]) && !touches(loop, rim)) {
        rim_of[loop] = rim;
        taken[rim].insert(single[loop][0].begin(), single[loop][0].end());
      }
  }
  std::vector<Hole> found;
  for (std::size_t l = 0; l < single.size(); ++l) {
    if (rim_of[l] != none) continue;
    found.push_back(single[l]);
    for (std::size_t k = 0; k < single.size(); ++k)
      if (rim_of[k] == l) found.back().push_back(single[k][0]);
  }
  return found;
}

}  // namespace fairing
