// SPDX-License-Identifier: GPL-3.0-or-later
#include "curvature/thin_rows.h"

#include <algorithm>

#include "grid/runs.h"

namespace fairing {
namespace {

struct ThinFace {
  int across;    // a side along its rows; of a quad the opposite one too
  double share;  // by which its rows become straight
};

class ThinRows {
 public:
  explicit ThinRows(SurfaceIterate& it) : it_(it), grid_(it.grid()), mesh_(grid_.mesh()) {
    for (const Face& face : mesh_.faces) faces_.push_back(shape_of(face));
    std::vector<double> share(faces_.size());
    for (std::size_t f = 0; f < share.size(); ++f) {
      const Face& face = mesh_.faces[f];
      share[f] = faces_[f].share;
      for (Index s = face.first_side; s < face.first_side + face.size; ++s)
        if (!is_across(s)) share[f] = std::min(share[f], share_beside(s));
    }
    for (std::size_t f = 0; f < share.size(); ++f) faces_[f].share = share[f];
  }

  bool any() const {
    return grid_.n() > 1 && std::ranges::any_of(faces_, [](auto& f) { return f.share > 0; });
  }

  void straighten() {
    const int n = grid_.n();
    for (const Index e : Cancellable(Index(mesh_.edges.size())))
      straighten_row(n, share_of(e), [&](int k) { return grid_.edge_point(e, k); });
    for (const Index f : Cancellable(Index(faces_.size()))) {
      const auto [across, share] = faces_[f];
      if (!(share > 0)) continue;
      const bool quad = mesh_.faces[f].quad();
      const auto edge = [&](int s) { return mesh_.sides[mesh_.faces[f].first_side + s].edge; };
      const double first = share_of(edge(across)), last = quad ? share_of(edge(across + 2)) : share;
      for (int r = 1; r < n; ++r)
        straighten_row(quad ? n : n - r, first + r * (last - first) / n, [&](int k) {
          return grid_.face_point(f, closed_point(quad, n, across, k, r));
        });
    }
  }

 private:
  Eigen::Map<Vec3> at(Index p) { return Eigen::Map<Vec3>(&it_.current.points[3 * std::size_t(p)]); }

  ThinFace shape_of(const Face& face) {
    const auto length = [&](int s) {
      return (at(face.vertex[(s + 1) % face.size]) - at(face.vertex[s % face.size])).norm();
    };
    const int sides = face.quad() ? 2 : 3;
    std::array<double, 3> l;
    for (int s = 0; s < sides; ++s) l[s] = length(s) + (face.quad() ? length(s + 2) : 0);
    const int across = int(std::min_element(l.begin(), l.begin() + sides) - l.begin());
    const double along = std::min(l[(across + 1) % sides], l[(across + sides - 1) % sides]);
    return {across, std::clamp(along / l[across] - 2, 0.0, 1.0)};
  }

  const ThinFace& face_of(Index s) const { return faces_[mesh_.sides[s].face]; }
  bool is_across(Index s) const {
    const Side& side = mesh_.sides[s];
    return side.local % (mesh_.faces[side.face].quad() ? 2 : 3) == face_of(s).across;
  }
  // Of the face beyond a side, if rows lead into it; of none: 1.
  double share_beside(Index s) const {
    const auto [left, right] = mesh_.edges[mesh_.sides[s].edge].side;
    const Index other = left == s ? right : left;
    if (other < 0) return 1;
    return is_across(other) ? 0 : face_of(other).share;
  }
  // Of the row along an edge.
  double share_of(Index e) const {
    double share = 1;
    for (const Index s : mesh_.edges[e].side)
      if (s >= 0) share = std::min(share, is_across(s) ? face_of(s).share : 0);
    return share;
  }

  // Points 1 … m - 1 of a row.
  template <class Point>
  void straighten_row(int m, double share, Point&& point) {
    if (!(share > 0)) return;
    const Vec3 first = at(point(0)), last = at(point(m));
    for (int k = 1; k < m; ++k) {
      const auto p = std::size_t(point(k));
      if (!(it_.op().diagonal()[p] > 0)) continue;  // not an unknown
      const Eigen::Map<const Vec3> normal(&it_.current.linearization.normal[3 * p]);
      const Vec3 move = share * (first + k * (last - first) / m - at(Index(p)));
      at(Index(p)) += move - move.dot(normal) * normal;
    }
  }

  SurfaceIterate& it_;
  const GridLevel& grid_;
  const ControlMesh& mesh_;
  std::vector<ThinFace> faces_;
};

}  // namespace

bool straighten_thin_rows(SurfaceIterate& it) {
  ThinRows rows(it);
  if (!rows.any()) return false;
  rows.straighten();
  it.system.symmetrize(it.level, it.current.points);
  it.linearize();
  return true;
}

}  // namespace fairing
