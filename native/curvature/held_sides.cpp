// SPDX-License-Identifier: GPL-3.0-or-later
#include "curvature/held_sides.h"

#include <Eigen/Geometry>
#include <algorithm>

#include "base/roundoff.h"
#include "curvature/connection.h"
#include "curvature/rings.h"

namespace fairing {
namespace {

class HeldShapes {
 public:
  HeldShapes(const GridLevel& grid, const Unknowns& unknowns, const double* x)
      : mesh_(grid.mesh()), unknowns_(unknowns), x_(x), shapes_(grid.size()) {
    RingWalk walk(grid, x, nullptr);
    ShapeRows rows;
    for (const Index v : Cancellable(mesh_.vertex_count())) {
      if (unknowns.vertex[v] || !mesh_.vertex_fit(v)) continue;
      const double share = share_of(v);
      if (!(share > 0)) continue;
      walk(vertex_run(v), [&](std::size_t, const RingInSpace& ring, bool closed) {
        linearize(ring.view(closed), CurvatureEnergy::total_curvature, rows);
        const PointCurvature& m = rows.point;
        if (m.has_rows())
          shapes_[v] = {{m.normal, chart_axis(m.normal, rows.chart)}, rows.shape, share};
      });
    }
  }

  std::vector<HeldSide> at_rim() const {
    std::vector<HeldSide> sides;
    double square = roundoff, noise = 0;
    for (std::size_t v = 0; v < shapes_.size(); ++v) {
      if (!(shapes_[v].share > 0 && shapes_[v].share < 1)) continue;
      Vec3 sum = Vec3::Zero();
      double known = 0, scatter = 0;
      for_held_beside(v, [&](std::size_t u, const Vec3& m) {
        sum += m;
        ++known;
        square += m.squaredNorm();
        scatter += scatter_at(u);
      });
      if (known == 0) continue;
      const double free = 1 - shapes_[v].share;
      noise += (1 + 1 / known) / (free * free) * scatter;  // of M' - M_h
      sides.resize(shapes_.size());
      sides[v] = {shapes_[v].share, sum / known};
    }
    for (HeldSide& side : sides) side.share *= std::max(0.0, 1 - noise / square);
    return sides;
  }

 private:
  struct ShapeAt : ChartAxes {
    Vec3 shape;
    double share = 0;
  };

  // Of the area around v, the share of faces whose corners are all held.
  double share_of(Index v) const {
    const auto at = [&](Index w) { return Eigen::Map<const Vec3>(x_ + 3 * std::size_t(w)); };
    double held = 0, all = 0;
    for (const Spoke& spoke : mesh_.ring(v)) {
      if (spoke.face < 0) return 0;
      const Face& face = mesh_.faces[spoke.face];
      const auto& c = face.vertex;
      const double area = (at(c[2]) - at(c[0])).cross(at(c[face.size - 1]) - at(c[1])).norm();
      all += area;
      if (std::none_of(c.begin(), c.begin() + face.size,
                       [&](Index w) { return unknowns_.vertex[w]; }))
        held += area;
    }
    return held / all;
  }

  // Calls visit(u, M of u in the chart of v) for the neighbours u around which nothing can move.
  template <class Visit>
  void for_held_beside(std::size_t v, Visit&& visit) const {
    for (const Spoke& spoke : mesh_.ring(Index(v))) {
      const auto u = std::size_t(mesh_.edges[spoke.edge].vertex[spoke.outward ? 1 : 0]);
      if (shapes_[u].share < 1) continue;
      const Eigen::Map<const Vec3> p(x_ + 3 * v), q(x_ + 3 * u);
      const Vec2 t = turn_between(shapes_[v], shapes_[u], q - p);
      const Vec3& m = shapes_[u].shape;
      visit(u, Vec3(m[0], t.x() * m[1] - t.y() * m[2], t.y() * m[1] + t.x() * m[2]));
    }
  }

  // Squared: of M at u about the mean of its neighbours.
  double scatter_at(std::size_t u) const {
    Vec3 sum = Vec3::Zero();
    double known = 0;
    for_held_beside(u, [&](std::size_t, const Vec3& m) { sum += m, ++known; });
    if (known == 0) return 0;
    return (shapes_[u].shape - sum / known).squaredNorm() * known / (1 + known);
  }

  const ControlMesh& mesh_;
  const Unknowns& unknowns_;
  const double* x_;
  std::vector<ShapeAt> shapes_;  // by vertex
};

}  // namespace

std::vector<HeldSide> held_sides(const GridLevel& grid, const Unknowns& unknowns, const double* x) {
  return HeldShapes(grid, unknowns, x).at_rim();
}

}  // namespace fairing
