// SPDX-License-Identifier: GPL-3.0-or-later
#include "splines/lattice.h"

#include <Eigen/Dense>
#include <algorithm>
#include <string>

#include "base/error.h"
#include "base/roundoff.h"
#include "parallel/cancel.h"

namespace fairing {
namespace {

constexpr int most_levels = 12;  // as in the message

void require_ids(std::span<const std::int32_t> ids, std::size_t points) {
  for (const std::size_t k : Cancellable(ids.size())) {
    if (ids[k] < 0 || std::size_t(ids[k]) >= points)
      throw FairingError(ErrorCode::index_out_of_range, "A refined face has the vertex " +
                                                            std::to_string(ids[k]) +
                                                            ", which is not in its surface.");
  }
}

double extent(std::span<const double> vertices) {
  double largest = 0;
  for (std::size_t a = 0; a < 3; ++a) {
    double low = 0, high = 0;
    for (std::size_t k = a; k < vertices.size(); k += 3) {
      stop_if_cancelled(k);
      low = k == a ? vertices[k] : std::min(low, vertices[k]);
      high = k == a ? vertices[k] : std::max(high, vertices[k]);
    }
    largest = std::max(largest, high - low);
  }
  return largest;
}

}  // namespace

Lattice::Lattice(const RefinedSurface& surface) : surface_(surface), n_(1) {
  if (surface.levels < 2 || surface.levels > most_levels)
    throw FairingError(ErrorCode::bad_option,
                       "levels is " + std::to_string(surface.levels) +
                           "; patches are fitted to lattices of levels 2 to 12.");
  n_ = 1 << surface.levels;
  const std::size_t cells = std::size_t(n_) * std::size_t(n_);
  if (surface.vertices.size() % 3 || surface.triangles.size() % (3 * cells) ||
      surface.quads.size() % (4 * cells) || surface.crease_edges.size() % 2)
    throw FairingError(ErrorCode::bad_shape, "The refined faces are not complete control faces.");
  triangle_faces_ = Index(surface.triangles.size() / (3 * cells));
  quad_faces_ = Index(surface.quads.size() / (4 * cells));
  require_ids(surface.triangles, points());
  require_ids(surface.quads, points());
  size_ = extent(surface.vertices);
}

Index Lattice::point(Index f, GridPoint p) const {
  const auto n = std::size_t(n_);
  if (quad(f)) {
    const int i = std::min(p.i, n_ - 1), j = std::min(p.j, n_ - 1);
    constexpr std::size_t corner_of[2][2] = {{0, 1}, {3, 2}};
    const std::size_t cell =
        std::size_t(f - triangle_faces_) * n * n + std::size_t(j) * n + std::size_t(i);
    return surface_.quads[4 * cell + corner_of[p.j - j][p.i - i]];
  }
  GridPoint cell = p;
  std::size_t corner = 0;
  if (p.i + p.j == n_) {  // on the side without cells of its own
    corner = p.i > 0 ? 1 : 2;
    (p.i > 0 ? cell.i : cell.j) -= 1;
  }
  const std::size_t left = n - std::size_t(cell.j);
  const std::size_t at = std::size_t(f) * n * n + n * n - left * left + 2 * std::size_t(cell.i);
  return surface_.triangles[3 * at + corner];
}

Sheet::Spot Sheet::spot(GridPoint p) const {
  if (many_.empty()) return {one_.face, p};
  const int n = lattice_.n(), at = place(p);
  const PlacedFace& placed = many_[at];
  if (!lattice_.quad(placed.face)) return {placed.face, p};
  return {placed.face,
          closed_point(true, n, placed.turn, p.i - at % columns_ * n, p.j - at / columns_ * n)};
}

Vec3 end_tangent(const Lattice& lattice, Index f, int s, bool at_end) {
  const auto at = [&](int k) {
    return lattice.position(lattice.point(f, s, at_end ? lattice.n() - k : k, 0));
  };
  return -11 * at(0) + 18 * at(1) - 9 * at(2) + 2 * at(3);
}

Eigen::Matrix<double, 3, 2> tangents_of(const Vec3& n) {
  const Vec3 t = n.unitOrthogonal();
  Eigen::Matrix<double, 3, 2> out;
  out << t, n.cross(t);
  return out;
}

Slide slide_to(const Vec3& rest, const Vec3& u, const Vec3& v) {
  const double uu = u.squaredNorm(), uv = u.dot(v), vv = v.squaredNorm(), det = uu * vv - uv * uv;
  if (!(det > roundoff * uu * vv)) return {0, 0};
  const double ru = u.dot(rest), rv = v.dot(rest);
  return {(vv * ru - uv * rv) / det, (uu * rv - uv * ru) / det};
}

std::span<const Vec3> NearbyPoints::last_face() const {
  const std::size_t before = ends.size() > 1 ? ends[ends.size() - 2] : 0;
  return std::span(points).subspan(before, ends.back() - before);
}

namespace {

// The least squares of fitted_normal().
class NormalFit {
 public:
  NormalFit(const NearbyPoints& nearby, double reach, const CurvatureJump& jump)
      : nearby_(nearby),
        reach_(reach),
        edge_(jump.edge),
        at_edge_(jump.jumps && !jump.edge.isZero()),
        by_face_(jump.jumps && !at_edge_) {
    const auto parts = by_face_ ? Eigen::Index(nearby.ends.size()) : 1;
    rows_.resize(Eigen::Index(nearby.points.size()),
                 2 + higher_terms * parts + (at_edge_ ? terms_beyond : 0));
    heights_.resize(rows_.rows());
  }

  // One refit.
  Vec3 next(const Vec3& normal) {
    const Eigen::Matrix<double, 3, 2> frame = tangents_of(normal);
    const Vec3 across = normal.cross(edge_);
    rows_.setZero();
    std::size_t face = 0;
    for (Eigen::Index k = 0; k < rows_.rows(); ++k) {
      while (std::size_t(k) == nearby_.ends[face]) ++face;
      const Vec3 arm = (nearby_.points[std::size_t(k)] - nearby_.centre) / reach_;
      set_row(k, face, arm.dot(frame.col(0)), arm.dot(frame.col(1)));
      if (at_edge_ && face > 0) set_jump(k, arm.dot(across), arm.dot(edge_));
      heights_[k] = arm.dot(normal);
    }
    Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr;
    qr.setThreshold(single_roundoff);
    qr.compute(rows_);
    return normal - frame * qr.solve(heights_).head<2>();
  }

 private:
  // Numbers of terms: quadratic and cubic ones; those beyond an edge.
  static constexpr Eigen::Index higher_terms = 7, terms_beyond = 3;

  void set_row(Eigen::Index k, std::size_t face, double x, double y) {
    rows_.row(k).head<2>() << x, y;
    rows_.row(k).segment<higher_terms>(2 + (by_face_ ? higher_terms * Eigen::Index(face) : 0))
        << x * x,
        x * y, y * y, x * x * x, x * x * y, x * y * y, y * y * y;
  }
  // s: from the edge; t: along it.
  void set_jump(Eigen::Index k, double s, double t) {
    rows_.row(k).tail<terms_beyond>() << s * s, s * s * t, s * s * s;
  }

  const NearbyPoints& nearby_;
  double reach_;
  Vec3 edge_;
  bool at_edge_, by_face_;
  Eigen::MatrixXd rows_;
  Eigen::VectorXd heights_;
};

}  // namespace

Vec3 fitted_normal(const NearbyPoints& nearby, const Vec3& guess, const CurvatureJump& jump) {
  double reach = 0;
  for (const Vec3& p : nearby.points) reach = std::max(reach, (p - nearby.centre).norm());
  if (!(reach > 0)) return guess;
  NormalFit fit(nearby, reach, jump);
  Vec3 normal = guess;
  for (int round = 0; round < 2; ++round) {
    const Vec3 next = fit.next(normal);
    if (!next.allFinite()) return normal;
    normal = next.normalized();
  }
  return normal;
}

Vec3 area_normal(const Sheet& sheet, GridPoint p) {
  const auto slope = [&](int di, int dj) {
    const GridPoint on{p.i + di, p.j + dj}, back{p.i - di, p.j - dj};
    return Vec3(sheet.position(sheet.inside(on) ? on : p) -
                sheet.position(sheet.inside(back) ? back : p));
  };
  // A triangle's far corners have neighbours in one of these directions only.
  const Vec3 u = slope(1, 0), v = slope(0, 1), w = slope(-1, 1);
  Vec3 normal = u.cross(v);
  if (!sheet.quads()) normal += u.cross(w) + w.cross(-v);
  return normal;
}

Vec3 lattice_normal(const Lattice& lattice, Index f, GridPoint p) {
  return area_normal(Sheet(lattice, f), p).normalized();
}

}  // namespace fairing
