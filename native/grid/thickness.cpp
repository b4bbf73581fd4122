// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/thickness.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>
#include <vector>

#include "base/angle.h"
#include "base/points.h"
#include "mesh/union_find.h"

namespace fairing {
namespace {

// A body is thin where its thickness is less than the width of the flat side. A change of thickness is
// visible from this share on, beyond that of a rounded body (measured: a fair section through 8
// points of a circle changes it by 8 %, a hollowed leading edge by 24 to 86 %). A body swells if
// this share of its area does; otherwise it is an ear or a lip (measured: 9 animals, mugs and cases
// up to 12 %, boxes and slabs 37 to 96 %).
constexpr double seen_share = 0.2;
// Where rounding its edges off lifts a face by less than this share, it is flat, and what makes its body
// thicker by as much is seen (measured under total curvature: phones, soap boxes and cans 30 % and more on
// 38 to 96 % of the area; spheres, tori, animals and Suzanne on less than a fifth).
constexpr double unlifted_share = 0.05;
// A bubble is thicker by so many thicknesses (measured: coarse levels of what becomes a sphere come to
// 1.3, bubbles in boxes of six quads begin at 8; by one, a hull of 8 points lost its sphere).
constexpr double lost_change = 4;

// The point at the centre of the face.
Vec3 middle(const GridLevel& grid, Index f, const double* x) {
  const int n = grid.n();
  const auto at = [&](int i, int j) { return point_at(x, grid.face_point(f, i, j)); };
  if (grid.mesh().faces[f].quad()) return at(n / 2, n / 2);
  // around the centre, or at the midpoints of sides if there is no inner point
  const int near = n / 4, far = n / 2;
  return n > 2 ? Vec3((at(near, near) + at(far, near) + at(near, far)) / 3)
               : Vec3((at(1, 0) + at(1, 1) + at(0, 1)) / 3);
}

// The point of the face nearest to the line behind another face's centre.
Vec3 behind(const GridLevel& grid, Index f, const FacePlane& line, const double* x) {
  const int n = grid.n();
  const bool quad = grid.mesh().faces[f].quad();
  Vec3 nearest;
  double least = std::numeric_limits<double>::infinity();
  for (int j = 0; j <= n; ++j)
    for (int i = 0; i <= (quad ? n : n - j); ++i) {
      const Vec3 point = point_at(x, grid.face_point(f, i, j));
      const double off = line.normal.cross(point - line.middle).squaredNorm();
      if (off < least) least = off, nearest = point;
    }
  return nearest;
}

// Distance of the face's centre from its side i, positive inside.
double inside(const Face& face, std::size_t i, const FacePlane& plane, const double* x) {
  const Vec3 from = point_at(x, face.vertex[i]);
  const Vec3 along = point_at(x, face.vertex[(i + 1) % std::size_t(face.size)]) - from;
  return (plane.middle - from).cross(unit_or_zero(along)).norm();
}

// Height by which rounded edges lift the centre of the face. An arc in place of two sides that turn
// by an angle rises by half a side times the tangent of a quarter of the angle; it reaches as far
// into the face as the face beyond the edge is wide.
double rounding_off(const ControlMesh& mesh, std::size_t f, std::span<const FacePlane> planes,
                    const double* x) {
  const Face& face = mesh.faces[f];
  double sum = 0;
  for (std::size_t i = 0; i < std::size_t(face.size); ++i) {
    const Side& side = mesh.sides[std::size_t(face.first_side) + i];
    const Edge& edge = mesh.edges[side.edge];
    if (edge.boundary() || mesh.feature_edge[side.edge]) continue;
    const Side& other = mesh.sides[edge.side[side.reversed ? 0 : 1]];
    const FacePlane &here = planes[f], &beyond = planes[other.face];
    const Vec3 along = point_at(x, edge.vertex[1]) - point_at(x, edge.vertex[0]);
    const double turn = std::copysign(angle_between(here.normal, beyond.normal),
                                      here.normal.cross(beyond.normal).dot(along)) *
                        (side.reversed ? -1 : 1);
    const double half = inside(face, i, here, x);
    const double width =
        2 * std::min(half, inside(mesh.faces[other.face], std::size_t(other.local), beyond, x));
    sum += std::tan(turn / 4) * width * width / std::max(half, width);
  }
  return sum / face.size;
}

// The normals around a control vertex: their sum, and the largest angle to it.
struct Cone {
  Vec3 axis = Vec3::Zero();
  double angle = 0;
};

// For each face the largest angle to a face around it, or somewhat more.
std::vector<double> turns_around(const ControlMesh& mesh, std::span<const FacePlane> planes) {
  std::vector<Cone> cones(std::size_t(mesh.vertex_count()));
  const auto for_corners = [&](auto&& visit) {
    for (std::size_t f = 0; f < planes.size(); ++f)
      for (std::size_t i = 0; i < std::size_t(mesh.faces[f].size); ++i)
        visit(f, cones[mesh.faces[f].vertex[i]]);
  };
  const auto to_axis = [&](std::size_t f, const Cone& cone) {
    return angle_between(planes[f].normal, cone.axis);
  };
  for_corners([&](std::size_t f, Cone& cone) { cone.axis += planes[f].normal; });
  for_corners(
      [&](std::size_t f, Cone& cone) { cone.angle = std::max(cone.angle, to_axis(f, cone)); });
  std::vector<double> out(planes.size(), 0.0);
  for_corners([&](std::size_t f, const Cone& cone) {
    out[f] = std::max(out[f], to_axis(f, cone) + cone.angle);
  });
  return out;
}

// Height to which a surface may rise over the face: that of half a circle across it, and that of
// an arc along it that turns by `turn`.
double highest_rise(const Face& face, const FacePlane& plane, double turn, const double* x) {
  double half_width = std::numeric_limits<double>::infinity(), length = 0;
  for (std::size_t i = 0; i < std::size_t(face.size); ++i) {
    half_width = std::min(half_width, inside(face, i, plane, x));
    const Index next = face.vertex[(i + 1) % std::size_t(face.size)];
    length = std::max(length, (point_at(x, next) - point_at(x, face.vertex[i])).norm());
  }
  return half_width + length / 2 * std::tan(std::min(turn, std::numbers::pi) / 4);
}

// Whether two faces are the sides of a wedge, whose edge is a crease: its thickness ends in nothing, and its
// sides may be hollow, as those of a bow are at a sharp stem.
bool is_wedge(const ControlMesh& mesh, Index f, Index o) {
  const Face& face = mesh.faces[f];
  for (std::size_t i = 0; i < std::size_t(face.size); ++i) {
    const Index e = mesh.sides[std::size_t(face.first_side) + i].edge;
    if (!mesh.feature_edge[e] || mesh.edges[e].boundary()) continue;
    if (mesh.face_beside(e, 0) == o || mesh.face_beside(e, 1) == o) return true;
  }
  return false;
}

// The area of the flat side that each face is a part of: whether a body is thin does not depend on how
// finely its sides are divided.
std::vector<double> areas_of_sides(const ControlMesh& mesh, std::span<const FacePlane> planes) {
  UnionFind parts(planes.size());
  for (Index e = 0; e < Index(mesh.edges.size()); ++e) {
    if (mesh.edges[e].boundary()) continue;
    const Index f = mesh.face_beside(e, 0), o = mesh.face_beside(e, 1);
    if (in_one_plane(planes[f], planes[o])) parts.unite(f, o);
  }
  std::vector<double> area(planes.size(), 0.0);
  for (std::size_t f = 0; f < planes.size(); ++f) area[parts.lead(Index(f))] += planes[f].area;
  for (std::size_t f = 0; f < planes.size(); ++f) area[f] = area[parts.lead(Index(f))];
  return area;
}

}  // namespace

Thickness::Thickness(const ControlMesh& mesh, std::span<const Vec3> control, Workers& workers)
    : mesh_(mesh) {
  for (const Face& face : mesh.faces) planes_.push_back(plane_of(face, control));
  for (std::size_t f = 0; f < planes_.size(); ++f)
    if (mesh.face_part(Index(f)) == RegionPart::inside) area_ += planes_[f].area;
  turn_ = turns_around(mesh, planes_);
  side_area_ = areas_of_sides(mesh, planes_);
  opposite_ = opposite_faces(mesh, control, planes_, workers);
}

Thickness::Departures Thickness::departures(const GridLevel& grid, Workers& workers,
                                            const double* x) const {
  Departures out{std::vector<double>(planes_.size()), std::vector<double>(planes_.size())};
  workers.for_each(planes_.size(), 64, [&](std::size_t f) {
    const auto departure = [&](std::size_t side, const Vec3& point) {
      return planes_[side].normal.dot(point - planes_[side].middle);
    };
    out.here[f] = departure(f, middle(grid, Index(f), x));
    const Index o = opposite_[f].face;
    if (o >= 0) out.behind[f] = departure(std::size_t(o), behind(grid, o, planes_[f], x));
  });
  return out;
}

ThicknessChange Thickness::of(const GridLevel& grid, Workers& workers, const double* x,
                              bool of_flats, const double* wanted) const {
  ThicknessChange out;
  if (grid.n() == 1) return out;
  const Departures own = departures(grid, workers, x);
  const std::vector<double> none(planes_.size());
  const Departures base = wanted ? departures(grid, workers, wanted) : Departures{none, none};
  std::vector<std::pair<Index, double>> seen;
  double swollen = 0;
  for (std::size_t f = 0; f < planes_.size(); ++f) {
    const Opposite& opposite = opposite_[f];
    if (mesh_.face_part(Index(f)) != RegionPart::inside) continue;
    if (opposite.face < 0) {
      if (std::abs(own.here[f] - base.here[f]) >
          highest_rise(mesh_.faces[f], planes_[f], turn_[f], x))
        out.bulging.push_back(Index(f));
      continue;
    }
    const auto o = std::size_t(opposite.face);
    const double facing = std::abs(planes_[f].normal.dot(planes_[o].normal));
    const double distance = opposite.distance + base.here[f] + facing * base.behind[f];
    if (!(distance > 0)) continue;  // what is wanted has passed through its opposite side
    const double change =
        (own.here[f] - base.here[f] + facing * (own.behind[f] - base.behind[f])) / distance;
    const double lifted = wanted ? 0.0 : rounding_off(mesh_, f, planes_, x) / distance;
    const double lifted_behind =
        wanted ? 0.0 : facing * rounding_off(mesh_, o, planes_, x) / distance;
    const double rounded = lifted + lifted_behind;
    const double otherwise =
        change - std::clamp(change, std::min(0.0, rounded), std::max(0.0, rounded));
    const double square = distance * distance;
    const bool is_thin = side_area_[f] > (1 + seen_share) * square;
    const bool is_flat = of_flats && otherwise > 0 &&
                         std::max(std::abs(lifted), std::abs(lifted_behind)) < unlifted_share;
    const double thin_share = is_flat ? unlifted_share : seen_share;
    const double thick_share = is_flat ? seen_share : 1.0;
    if (!(std::abs(otherwise) > (is_thin ? thin_share : thick_share))) continue;
    if (change < 0 && is_wedge(mesh_, Index(f), opposite.face)) continue;
    seen.emplace_back(Index(f), change);
    if (change > 0) swollen += planes_[f].area / area_;
    if (std::abs(change) > lost_change) out.lost += planes_[f].area / area_;
  }
  for (const auto& [face, change] : seen) {
    if (change > 0 && swollen < seen_share) continue;
    out.faces.push_back(face);
    if (std::abs(change) > std::abs(out.worst)) out.worst = change;
  }
  return out;
}

}  // namespace fairing
