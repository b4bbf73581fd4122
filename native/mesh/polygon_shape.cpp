// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/polygon_shape.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "parallel/cancel.h"

namespace fairing {
namespace {

constexpr double tan_10_degrees = 0.17632698070846498;
constexpr double cos_60_degrees = 0.5;
// Of a star's sides from its centre, relative to the root of its area.
constexpr double least_distance = 0.01;
constexpr double least_flatness = 1e-9;  // a triangle's projected area over its sides' squares

double cross(const Vec2& a, const Vec2& b) { return a.x() * b.y() - a.y() * b.x(); }

constexpr double infinite = std::numeric_limits<double>::infinity();
constexpr double tie = 1e-6;

struct Diagonal {
  std::size_t i, j;  // i < j
  bool crosses(const Diagonal& d) const {
    return (i < d.i && d.i < j && j < d.j) || (d.i < i && i < d.j && d.j < j);
  }
};

// cost(i, length): the least badness of the part between the diagonal (i, i + length) and the sides
// from i on to i + length. All starts i are tabulated, round the corner too: then the two sides of
// a diagonal together give the cost of the best triangulation that uses it.
class Costs {
 public:
  Costs(const PolygonShape& shape, const std::function<bool(std::size_t, std::size_t)>& allowed)
      : n_(shape.size()), cost_(n_ * n_, infinite) {
    for (std::size_t i = 0; i < n_; ++i) at(i, 1) = 0;
    for (std::size_t length = 2; length < n_; ++length) {
      stop_if_cancelled();
      for (std::size_t i = 0; i < n_; ++i)
        if (length == n_ - 1 || allowed(i, (i + length) % n_))
          at(i, length) = best(shape, i, length);
    }
  }

  double whole() const { return cost_[n_ - 1]; }
  double with(const Diagonal& d) const {
    const std::size_t length = d.j - d.i;
    return cost_[d.i * n_ + length] + cost_[d.j * n_ + n_ - length];
  }

 private:
  double& at(std::size_t i, std::size_t length) { return cost_[i * n_ + length]; }

  double best(const PolygonShape& shape, std::size_t i, std::size_t length) {
    double least = infinite;
    for (std::size_t middle = 1; middle < length; ++middle) {
      const std::size_t m = (i + middle) % n_;
      const double parts = at(i, middle) + at(m, length - middle);
      if (parts < least) least = std::min(least, parts + shape.badness(i, m, (i + length) % n_));
    }
    return least;
  }

  std::size_t n_;
  std::vector<double> cost_;
};

std::vector<Diagonal> undisputed(const std::vector<Diagonal>& diagonals) {
  std::vector<Diagonal> kept;
  for (const Diagonal& d : diagonals)
    if (std::none_of(diagonals.begin(), diagonals.end(),
                     [&](const Diagonal& e) { return d.crosses(e); }))
      kept.push_back(d);
  return kept;
}

std::vector<Piece> cut(std::size_t corners, const std::vector<Diagonal>& diagonals) {
  std::vector<Piece> pieces(1, Piece(corners));
  std::iota(pieces[0].begin(), pieces[0].end(), std::size_t(0));
  for (const Diagonal& d : diagonals) {
    // The diagonals do not cross: exactly one piece holds both ends.
    for (Piece& piece : pieces) {
      const auto first = std::find(piece.begin(), piece.end(), d.i),
                 last = std::find(first, piece.end(), d.j);
      if (last == piece.end()) continue;
      const Piece inner(first, last + 1);
      piece.erase(first + 1, last);
      pieces.push_back(inner);
      break;
    }
  }
  return pieces;
}

}  // namespace

PolygonShape::PolygonShape(std::span<const Vec3> corners) {
  const std::size_t n = corners.size();
  Vec3 mean = Vec3::Zero();
  for (const Vec3& p : corners) mean += (p - corners[0]) / double(n);
  mean += corners[0];
  for (const Vec3& p : corners) corners_.push_back(p - mean);

  Vec3 area = Vec3::Zero();
  for (std::size_t i = 0; i < n; ++i) area += 0.5 * corners_[i].cross(corners_[(i + 1) % n]);
  area_ = area.norm();
  normal_ = area / area_;

  Vec3 moment = Vec3::Zero();
  for (std::size_t i = 0; i < n; ++i) {
    const Vec3 &a = corners_[i], &b = corners_[(i + 1) % n];
    moment += 0.5 * normal_.dot(a.cross(b)) * (a + b) / 3;
  }
  centroid_ = mean + moment / area_;

  const Vec3 u = normal_.unitOrthogonal(), v = normal_.cross(u);
  for (const Vec3& p : corners_) plane_.emplace_back(u.dot(p), v.dot(p));
  centre_ = Vec2(u.dot(moment), v.dot(moment)) / area_;
}

bool PolygonShape::star_shaped() const {
  for (std::size_t i = 0; i < size(); ++i) {
    const Vec2 a = plane_[i] - centre_, b = plane_[(i + 1) % size()] - centre_;
    if (!(cross(a, b) > least_distance * std::sqrt(area_) * (b - a).norm())) return false;
  }
  return true;
}

bool PolygonShape::concave() const {
  for (std::size_t i = 0; i < size(); ++i) {
    const Vec2 in = plane_[i] - plane_[(i + size() - 1) % size()];
    const Vec2 out = plane_[(i + 1) % size()] - plane_[i];
    const double turn = cross(in, out), ahead = in.dot(out);
    if (!(turn > 0) || turn < tan_10_degrees * ahead) return true;
  }
  return false;
}

Vec3 PolygonShape::corner_area(std::size_t i) const {
  const std::size_t n = size();
  return (corners_[i] - corners_[(i + n - 1) % n]).cross(corners_[(i + 1) % n] - corners_[i]);
}

bool PolygonShape::warped() const {
  const auto cosine = [](const Vec3& a, const Vec3& b) { return a.dot(b) / (a.norm() * b.norm()); };
  const double along_02 = cosine(corner_area(1), corner_area(3));
  const double along_13 = cosine(corner_area(0), corner_area(2));
  return !(std::max(along_02, along_13) >= cos_60_degrees);
}

double PolygonShape::badness(std::size_t i, std::size_t j, std::size_t k) const {
  const double squares = (corners_[i] - corners_[j]).squaredNorm() +
                         (corners_[j] - corners_[k]).squaredNorm() +
                         (corners_[k] - corners_[i]).squaredNorm();
  const double twice_area = cross(plane_[j] - plane_[i], plane_[k] - plane_[i]);
  if (!(twice_area > least_flatness * squares)) return std::numeric_limits<double>::infinity();
  return squares / (2 * std::sqrt(3.0) * twice_area);
}

std::vector<Piece> cut_polygon(const PolygonShape& shape,
                               const std::function<bool(std::size_t, std::size_t)>& allowed) {
  const std::size_t n = shape.size();
  const Costs costs(shape, allowed);
  std::vector<Diagonal> best;
  if (std::isfinite(costs.whole()))
    for (std::size_t i = 0; i + 2 < n; ++i)
      for (std::size_t j = i + 2; j < n && j - i < n - 1; ++j)
        if (costs.with({i, j}) <= costs.whole() * (1 + tie)) best.push_back({i, j});
  return cut(n, undisputed(best));
}

}  // namespace fairing
