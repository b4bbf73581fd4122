// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/thickness.h"

#include <array>
#include <cmath>

#include "base/points.h"

namespace fairing {
namespace {

// A body is thin where a face is wider than the body is thick there: round ones, of which a cube is
// the coarsest, are not. Thinner and thicker by this share is what a designer sees (measured: a fair
// section through 8 points of a circle changes it by 8 %, a hollowed leading edge by 24 to 86 %).
constexpr double seen_share = 0.2;
// A bubble is thicker by so many thicknesses (measured: coarse levels of what becomes a sphere come to
// 1.3, bubbles in boxes of six quads begin at 8; by one, a hull of 8 points lost its sphere).
constexpr double lost_change = 4;

// How far the middle of the face has left its plane, along its normal.
double departure(const GridLevel& grid, Index f, const FacePlane& plane, const double* x) {
  const int n = grid.n();
  const auto at = [&](int i, int j) { return point_at(x, grid.face_point(f, i, j)); };
  if (grid.mesh().faces[std::size_t(f)].quad())
    return plane.normal.dot(at(n / 2, n / 2) - plane.middle);
  // around the middle, or in the middles of sides where no point lies inside
  const int near = n / 4, far = n / 2;
  const Vec3 middle = n > 2 ? Vec3((at(near, near) + at(far, near) + at(near, far)) / 3)
                            : Vec3((at(1, 0) + at(1, 1) + at(0, 1)) / 3);
  return plane.normal.dot(middle - plane.middle);
}

}  // namespace

Thickness::Thickness(const ControlMesh& mesh, std::span<const Vec3> control, Workers& workers)
    : mesh_(mesh) {
  for (const Face& face : mesh.faces) planes_.push_back(plane_of(face, control));
  for (const FacePlane& plane : planes_) area_ += plane.area;
  opposite_ = opposite_faces(mesh, control, planes_, workers);
}

ThicknessChange Thickness::of(const GridLevel& grid, Workers& workers, const double* x) const {
  ThicknessChange out;
  if (grid.n() == 1) return out;
  std::vector<double> away(planes_.size());
  workers.for_parts(away.size(), 1024, [&](std::size_t begin, std::size_t end) {
    for (std::size_t f = begin; f < end; ++f) away[f] = departure(grid, Index(f), planes_[f], x);
  });
  for (std::size_t f = 0; f < planes_.size(); ++f) {
    const Opposite& opposite = opposite_[f];
    if (opposite.face < 0 || mesh_.face_part(Index(f)) != RegionPart::inside) continue;
    const auto o = std::size_t(opposite.face);
    const double facing = std::abs(planes_[f].normal.dot(planes_[o].normal));
    const double change = (away[f] + facing * away[o]) / opposite.distance;
    const double square = opposite.distance * opposite.distance;
    const bool is_thin = planes_[f].area > (1 + seen_share) * square;
    if (!(std::abs(change) > (is_thin ? seen_share : 1.0))) continue;
    out.faces.push_back(Index(f));
    if (std::abs(change) > std::abs(out.worst)) out.worst = change;
    if (std::abs(change) > lost_change) out.lost += planes_[f].area / area_;
  }
  return out;
}

}  // namespace fairing
