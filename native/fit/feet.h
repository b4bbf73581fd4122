// SPDX-License-Identifier: GPL-3.0-or-later
// Feet: the points of a surface nearest to those of a scan. The normal of a foot's cell agrees with
// that of the scan's point, if known, so that the two sides of a thin wall are not confused.
#pragma once

#include "fit/cells.h"
#include "fit/scan.h"

namespace fairing {

struct Foot {
  Index cell = -1;  // -1: no foot
  CornerShares shares{};
  // Distance of the scan's point along the surface's normal at the foot; working units.
  float offset = 0;
  // Beyond the surface's border; it is ignored.
  bool outside = false;

  bool is_used() const { return cell >= 0 && !outside; }
};

// The present surface of a level, with its normals, and feet on it.
class FeetFinder {
 public:
  // `reach`: how much farther than the nearest point of the surface a foot with an agreeing normal
  // may be. References must outlive it. May throw FairingError(cancelled).
  FeetFinder(const Cells& cells, const Scan& scan, double reach, Workers& workers);

  // Changes the surface to x, 3 numbers a point.
  void set_surface(const double* x);
  // Normal of the surface at a foot: the mean of the corners' normals; on curves that of the cell.
  Vec3 normal_at(const Foot& foot) const { return normal_at(foot, corner_normals(foot.cell)); }
  // The same with known normals of the cell's corners.
  static Vec3 normal_at(const Foot& foot, const std::array<Vec3, 4>& corners);
  std::array<Vec3, 4> corner_normals(Index cell) const;
  // On a parabola over the cell: half way to the mean of its corners' tangent planes [Boubekeur, Alexa
  // 2008]. (Through a flat cell noise would be the same, and surfaces too wide where they are round.)
  Vec3 point_at_foot(const Foot& foot) const {
    return point_at_foot(foot, corner_normals(foot.cell));
  }
  // Distance of a scan's point from its foot, positive on the side of the normal.
  double distance(std::size_t point, const Foot& foot) const {
    const double far = (scan_.point[point] - point_at_foot(foot)).norm();
    return foot.offset < 0 ? -far : far;
  }

  // Finds all feet, starting at the nearest point of the surface. `any_side`: ignores normals.
  void find(Array<Foot>& feet, bool any_side = false) const;
  // Finds again the feet that are farther away than `distance`, or missing.
  void find_beyond(double distance, Array<Foot>& feet) const;
  // Updates feet after a small move of the surface, by descent from cell to cell.
  void follow(Array<Foot>& feet) const;
  // Updates the offsets only; the feet stay.
  void measure(Array<Foot>& feet) const;

  const Cells& cells() const { return cells_; }

 private:
  struct Nearest {
    CornerShares shares;
    double square;  // of the distance
  };
  Vec3 point_at_foot(const Foot& foot, const std::array<Vec3, 4>& normals) const;
  Vec3 at(Index p) const { return Eigen::Map<const Vec3>(x_ + 3 * std::size_t(p)); }
  Nearest nearest_on(Index cell, const Vec3& point) const;
  bool agrees(Index cell, std::size_t point) const;
  void search(Array<Foot>& feet, bool any_side, double beyond) const;
  bool descend(std::size_t point, Index at, Foot& foot, double square) const;
  void finish(std::size_t point, Foot& foot) const;
  bool is_on_border(const Foot& foot) const;

  const Cells& cells_;
  const Scan& scan_;
  double reach_;
  Workers& workers_;
  const double* x_ = nullptr;
  Array<Vec3> cell_normal_;   // unit length
  Array<Vec3> point_normal_;  // the same; zero on curves
  std::vector<std::uint8_t> on_curve_, on_border_;
};

}  // namespace fairing
