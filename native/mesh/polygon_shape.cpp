// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/polygon_shape.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <numeric>

#include "base/angle.h"
#include "base/points.h"
#include "base/roundoff.h"
#include "mesh/sharp_turn.h"
#include "parallel/cancel.h"

namespace fairing {
namespace {

// Least distance of a star's sides from its centre, relative to the root of its area.
constexpr double least_distance = 0.01;

double cross(const Vec2& a, const Vec2& b) { return a.x() * b.y() - a.y() * b.x(); }

// Sums with the same bits for any order of the terms, and with the negative bits if all terms
// change their sign: positive and negative terms are summed separately, in ascending order.
class OrderFreeSum {
 public:
  explicit OrderFreeSum(std::size_t terms) {
    for (auto& of_component : term_) of_component.reserve(terms);
  }
  void add(const Vec3& v) {
    for (std::size_t a = 0; a < 3; ++a) term_[a].push_back(v[a]);
  }
  Vec3 total() {
    Vec3 out;
    for (std::size_t a = 0; a < 3; ++a) {
      std::vector<double>& term = term_[a];
      std::sort(term.begin(), term.end());
      const auto positive = std::lower_bound(term.begin(), term.end(), 0.0);
      const double gained = std::accumulate(positive, term.end(), 0.0),
                   lost = std::accumulate(std::make_reverse_iterator(positive), term.rend(), 0.0);
      out[a] = gained + lost;
    }
    return out;
  }

 private:
  std::array<std::vector<double>, 3> term_;
};

// The mean of the corners. The centre of the bounding box does not rotate with them, and the
// centroid of a polygon that is not planar depends on the first triangle of the sum.
Vec3 mean(std::span<const Vec3> p) {
  if (p.size() == 4) return 0.25 * ((p[0] + p[2]) + (p[1] + p[3]));
  Vec3 least = p[0], most = p[0];
  for (const Vec3& q : p) {
    least = least.cwiseMin(q);
    most = most.cwiseMax(q);
  }
  const Vec3 middle = 0.5 * least + 0.5 * most;
  OrderFreeSum sum(p.size());
  for (const Vec3& q : p) sum.add(q - middle);
  return middle + sum.total() / double(p.size());
}

constexpr double infinite = std::numeric_limits<double>::infinity();

struct Diagonal {
  std::size_t i, j;  // i < j
  bool crosses(const Diagonal& d) const {
    return (i < d.i && d.i < j && j < d.j) || (d.i < i && i < d.j && d.j < j);
  }
};

// cost(i, length): least badness of the part between the diagonal (i, i + length) and the sides
// from i to i + length, for all starts i, cyclically. The sum of the two sides of a diagonal is the
// cost of the best triangulation with that diagonal.
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

  // The same for every start, up to rounding.
  double whole() const {
    double least = infinite;
    for (std::size_t i = 0; i < n_; ++i) least = std::min(least, cost_[i * n_ + n_ - 1]);
    return least;
  }
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
    // Diagonals do not cross, so exactly one piece has both ends.
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

Vec3 twice_vector_area(const PolygonMesh& mesh, std::int64_t f) {
  const auto face = mesh.face(f);
  const auto spoke = [&, origin = point_at(mesh.coordinates, face[0])](std::size_t i) -> Vec3 {
    return point_at(mesh.coordinates, face[i]) - origin;
  };
  Vec3 sum = Vec3::Zero();
  for (std::size_t i = 1; i + 1 < face.size(); ++i) sum += spoke(i).cross(spoke(i + 1));
  return sum;
}

PolygonShape::PolygonShape(std::span<const Vec3> corners) : origin_(mean(corners)) {
  for (const Vec3& p : corners) corners_.push_back(p - origin_);
  const Vec3 area = vector_area();
  area_ = area.norm();
  normal_ = area / area_;
  along_ = normal_.unitOrthogonal();
  across_ = normal_.cross(along_);
  for (const Vec3& p : corners_) plane_.push_back(project(p));
}

Vec3 PolygonShape::vector_area() const {
  const std::size_t n = size();
  if (n == 4) return 0.5 * (corners_[2] - corners_[0]).cross(corners_[3] - corners_[1]);
  OrderFreeSum area(n);
  for (std::size_t i = 0; i < n; ++i) area.add(0.5 * corners_[i].cross(corners_[(i + 1) % n]));
  return area.total();
}

Vec3 PolygonShape::centre_of_area() const {
  const std::size_t n = size();
  OrderFreeSum moment(n);
  for (std::size_t i = 0; i < n; ++i) {
    const Vec3 &a = corners_[i], &b = corners_[(i + 1) % n];
    moment.add(0.5 * normal_.dot(a.cross(b)) * (a + b) / 3);
  }
  return moment.total() / area_;
}

bool PolygonShape::star_shaped() const {
  const Vec2 centre = project(centre_of_area());
  for (std::size_t i = 0; i < size(); ++i) {
    const Vec2 a = plane_[i] - centre, b = plane_[(i + 1) % size()] - centre;
    if (!(cross(a, b) > least_distance * std::sqrt(area_) * (b - a).norm())) return false;
  }
  return true;
}

bool PolygonShape::concave() const {
  for (std::size_t i = 0; i < size(); ++i) {
    const Vec2 in = plane_[i] - plane_[(i + size() - 1) % size()];
    const Vec2 out = plane_[(i + 1) % size()] - plane_[i];
    const double turn = cross(in, out), ahead = in.dot(out);
    // 180 degrees, up to rounding in a file, is concave
    if (!(turn > 0) || turn < collinear * ahead) return true;
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
  return !(std::max(along_02, along_13) >= sharp_turn);
}

double PolygonShape::badness(std::size_t i, std::size_t j, std::size_t k) const {
  const double squares = (corners_[i] - corners_[j]).squaredNorm() +
                         (corners_[j] - corners_[k]).squaredNorm() +
                         (corners_[k] - corners_[i]).squaredNorm();
  const double twice_area = cross(plane_[j] - plane_[i], plane_[k] - plane_[i]);
  if (!(twice_area > roundoff * squares)) return infinite;
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
        // rounding must not decide between triangulations
        if (costs.with({i, j}) <= costs.whole() * (1 + single_roundoff)) best.push_back({i, j});
  return cut(n, undisputed(best));
}

}  // namespace fairing
