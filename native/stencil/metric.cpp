// SPDX-License-Identifier: GPL-3.0-or-later
#include "stencil/metric.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <numbers>
#include <queue>
#include <utility>

#include "base/angle.h"
#include "mesh/opposite.h"
#include "mesh/union_find.h"
#include "parallel/cancel.h"

namespace fairing {
namespace {

// Ridges: strips of quads much longer than the radius by which the mesh turns across them.
//
// Number 2 f + k is a quad in the direction of its sides k and k + 2: these are its long sides, the
// others its ends. Quads that share ends form a strip.
class Ridges {
 public:
  Ridges(const ControlMesh& mesh, double exponent)
      : mesh_(mesh), strips_(2 * mesh.faces.size()), shares_(2 * mesh.faces.size(), 1.0) {
    planes_.reserve(mesh.faces.size());
    for (const Face& face : mesh.faces) planes_.push_back(plane_of(face, mesh.positions));
    for (std::size_t k = 0; k < shares_.size(); ++k) {
      for (const int s : ends(k)) {
        if (const Side* const other = beside(k / 2, s); joins(other)) {
          strips_.unite(Index(k), along(*other, 1));
        }
      }
    }
    find(exponent);
  }

  std::vector<std::array<double, 2>> run() {
    while (!next_.empty()) {
      const auto [share, k] = next_.top();
      next_.pop();
      if (share > shares_[k]) continue;
      for (const int s : ends(k)) pass(k, s, 1, share);
      for (const int s : long_sides(k)) pass(k, s, 0, 1.25 * share);
    }
    std::vector<std::array<double, 2>> of_faces(planes_.size());
    for (std::size_t k = 0; k < shares_.size(); ++k)
      of_faces[k / 2][k % 2] = shares_[k] * (mesh_.flat.face.empty() ? 1.0 : arc(k ^ 1));
    return of_faces;
  }

 private:
  static std::array<int, 2> long_sides(std::size_t k) { return {int(k % 2), int(k % 2) + 2}; }
  static std::array<int, 2> ends(std::size_t k) { return {1 - int(k % 2), 3 - int(k % 2)}; }
  static Index along(const Side& side, int ends) { return 2 * side.face + (side.local + ends) % 2; }

  bool quad(std::size_t f) const { return mesh_.faces[f].quad(); }
  bool joins(const Side* other) const { return other && quad(std::size_t(other->face)); }

  // The side of the next face across side s of a quad; null at borders, creases, triangles.
  const Side* beside(std::size_t f, int s) const {
    if (!quad(f)) return nullptr;
    const Index own = mesh_.faces[f].first_side + s;
    const Index e = mesh_.sides[own].edge;
    const Edge& edge = mesh_.edges[e];
    if (edge.boundary() || mesh_.feature_edge[e]) return nullptr;
    return &mesh_.sides[edge.side[edge.side[0] == own ? 1 : 0]];
  }

  Vec3 side(std::size_t f, int s) const {
    const Face& face = mesh_.faces[f];
    return mesh_.positions[face.vertex[(s + 1) % face.size]] - mesh_.positions[face.vertex[s]];
  }

  // Positive if the mesh is convex.
  double angle(std::size_t f, std::size_t o) const {
    const double angle = angle_between(planes_[f].normal, planes_[o].normal);
    return planes_[f].normal.dot(planes_[o].middle - planes_[f].middle) > 0 ? -angle : angle;
  }

  // The excess of the turns at the long sides over those at the ends. Each turn is divided between
  // the two faces by their widths.
  double turn(std::size_t k) const {
    const std::size_t f = k / 2;
    double across = 0, at_ends = 0;
    for (const int s : long_sides(k)) {
      if (const Side* const other = beside(f, s)) {
        const auto o = std::size_t(other->face);
        across += angle(f, o) * planes_[f].area / (planes_[f].area + planes_[o].area);
      }
    }
    for (const int s : ends(k)) {
      if (const Side* const other = beside(f, s)) {
        at_ends += std::abs(angle(f, std::size_t(other->face)));
      }
    }
    return std::abs(across) - at_ends;
  }

  bool goes_on(std::size_t k) const {
    return std::ranges::all_of(ends(k), [&](int s) {
      const Side* const other = beside(k / 2, s);
      return !other || joins(other);
    });
  }

  // Between flats, for a quad whose long sides are those of k: the width that a cubic needs to be
  // an arc, tangent to straight lines with speed one on both sides, relative to the chord.
  double arc(std::size_t k) const {
    if (!quad(k / 2)) return 1;
    double turn = 0;
    for (const int s : long_sides(k))
      if (const Side* const other = beside(k / 2, s); other && !is_stiff(k / 2, s))
        turn += angle_between(planes_[k / 2].normal, planes_[other->face].normal) /
                (is_stiff(std::size_t(other->face), other->local) ? 1 : 2);
    const double by = std::cos(std::min(turn, std::numbers::pi / 2) / 4);
    return 1 / (by * by);
  }

  // Whether a face does not bend across its side s.
  bool is_stiff(std::size_t f, int s) const { return mesh_.flat.is_stiff(Index(f), side(f, s)); }

  // Starts with the strips that are ridges along their whole length.
  void find(double exponent) {
    std::vector<double> shares(shares_.size(), 1.0);  // of strips, by their leaders; 0: not a ridge
    for (const std::size_t k : Cancellable(shares.size())) {
      double& share = shares[strips_.lead(Index(k))];
      const double by = quad(k / 2) && goes_on(k) ? turn(k) : 0;
      if (!(by > 0)) {
        share = 0;
      } else if (share > 0) {
        share = std::min(share, std::max(1.0, 1 / by) / std::pow(slenderness(k), exponent));
      }
    }
    drop_rims(shares);
    for (std::size_t k = 0; k < shares.size(); ++k) {
      if (const double share = shares[strips_.lead(Index(k))]; share > 0) {
        lower(k, share);
      }
    }
  }

  // Flat and straight faces hold the curvature across the strips between them, so these are no ridges.
  void drop_rims(std::vector<double>& shares) {
    const auto share = [&](std::size_t k) -> double& { return shares[strips_.lead(Index(k))]; };
    std::vector<std::size_t> found;
    for (std::size_t k = 0; k < shares.size(); ++k)
      for (const int s : long_sides(k))
        if (const Side* const other = beside(k / 2, s); other && mesh_.flat.is_kept(other->face))
          found.push_back(k);
    while (!found.empty()) {
      const std::size_t k = found.back();
      found.pop_back();
      if (!(share(k) > 0)) continue;
      share(k) = 0;
      for (const int s : long_sides(k))
        if (const Side* const other = beside(k / 2, s); joins(other))
          found.push_back(std::size_t(along(*other, 0)));
    }
  }

  double slenderness(std::size_t k) const {
    const auto sum = [&](const std::array<int, 2>& s) {
      return side(k / 2, s[0]).norm() + side(k / 2, s[1]).norm();
    };
    return sum(long_sides(k)) / sum(ends(k));
  }

  void pass(std::size_t k, int s, int ends, double share) {
    const Side* const other = beside(k / 2, s);
    if (joins(other)) lower(std::size_t(along(*other, ends)), share);
  }

  void lower(std::size_t k, double share) {
    if (!(share < shares_[k])) return;
    shares_[k] = share;
    next_.emplace(share, k);
  }

  using Next = std::pair<double, std::size_t>;

  const ControlMesh& mesh_;
  UnionFind strips_;
  std::vector<FacePlane> planes_;
  std::vector<double> shares_;
  std::priority_queue<Next, std::vector<Next>, std::greater<>> next_;
};

// Factors of lengths raised to the exponent in the control metric: for each face along its sides 0
// and 2, and along its sides 1 and 3. 1 off ridges, for triangles, and for the exponents 0 and 1.
//
// Between the ends of long quads no vertex holds the curvature across them. The surface of least
// energy through rings of a tube with the radius r, l apart, is hollow half way between them by (l
// / r)^4 / 384 of r where l is small, by 3 % for l = 2 r, and by all of r where l is large. So
// along a strip of quads that is such a tube no quad counts as longer than the radius. A tube runs
// from border to border, from crease to crease or into itself, and all along it the mesh turns by
// less from quad to quad than across it; the sides and bevels of boxes do not qualify. A strip is
// shortened as a whole, because the surface waves where lengths jump; so the strips beside it
// follow, each by up to a quarter less.
std::vector<std::array<double, 2>> ridge_shares(const ControlMesh& mesh, double exponent) {
  if (exponent == 0 || exponent == 1 || std::ranges::none_of(mesh.faces, &Face::quad)) {
    return std::vector<std::array<double, 2>>(mesh.faces.size(), {1.0, 1.0});
  }
  return Ridges(mesh, exponent).run();
}

// The angle between sides a and b of a triangle with third side c.
double corner_angle(double a, double b, double c) {
  return std::acos(std::clamp((a * a + b * b - c * c) / (2 * a * b), -1.0, 1.0));
}

// Kahan's stable form of Heron's area.
double triangle_area(double a, double b, double c) {
  if (a < b) std::swap(a, b);
  if (a < c) std::swap(a, c);
  if (b < c) std::swap(b, c);
  return 0.25 *
         std::sqrt(std::max(0.0, (a + (b + c)) * (c - (a - b)) * (c + (a - b)) * (a + (b - c))));
}

FlatFace flat_triangle(const std::array<Vec3, 3>& p, double exponent) {
  std::array<double, 3> l;
  for (std::size_t s = 0; s < 3; ++s) l[s] = std::pow((p[(s + 1) % 3] - p[s]).norm(), exponent);
  FlatFace flat{};
  for (std::size_t s = 0; s < 3; ++s) {
    flat.length[s] = l[s];
    flat.angle[s] = corner_angle(l[s], l[(s + 2) % 3], l[(s + 1) % 3]);
  }
  flat.area = triangle_area(l[0], l[1], l[2]);
  return flat;
}

FlatFace flat_quad(const std::array<Vec3, 4>& p, const std::array<double, 2>& shares,
                   double exponent) {
  Vec3 u = 0.5 * ((p[1] - p[0]) + (p[2] - p[3])), v = 0.5 * ((p[3] - p[0]) + (p[2] - p[1]));
  if (shares[0] != 1) u *= std::pow(shares[0], 1 / exponent);
  if (shares[1] != 1) v *= std::pow(shares[1], 1 / exponent);
  const double a = std::pow(u.norm(), exponent), b = std::pow(v.norm(), exponent);
  const double plus = std::pow((u + v).norm(), exponent),
               minus = std::pow((u - v).norm(), exponent);
  const double angle =
      0.5 * ((std::numbers::pi - corner_angle(a, b, plus)) + corner_angle(a, b, minus));
  FlatFace flat;
  flat.length = {a, b, a, b};
  flat.angle = {angle, std::numbers::pi - angle, angle, std::numbers::pi - angle};
  flat.area = a * b * std::sin(angle);
  return flat;
}

FlatFace flat_face(const ControlMesh& mesh, const Face& face, const std::array<double, 2>& shares,
                   double exponent) {
  const auto at = [&](std::size_t c) -> const Vec3& { return mesh.positions[face.vertex[c]]; };
  return face.quad() ? flat_quad({at(0), at(1), at(2), at(3)}, shares, exponent)
                     : flat_triangle({at(0), at(1), at(2)}, exponent);
}

// Gives parts of several flat faces their own shape, at the scale that keeps the length of their
// outline. With another exponent the angles around a vertex inside are no full turn, so that a stiff
// plate would bend, or push its rim away.
class FlatShapes {
 public:
  FlatShapes(const ControlMesh& mesh, std::vector<FlatFace>& flat)
      : mesh_(mesh), flat_(flat), part_(mesh.faces.size()) {}

  void keep() {
    for (Index f = 0; f < Index(mesh_.faces.size()); ++f) measure(f);
    for (Index f = 0; f < Index(mesh_.faces.size()); ++f) {
      const Part& part = part_[mesh_.flat.part[f]];
      if (mesh_.flat.face[f] && part.faces > 1) set(f, part.in_metric / part.in_space);
    }
  }

 private:
  struct Part {
    double in_metric = 0, in_space = 0;  // lengths of its outline
    int faces = 0;
  };

  // Whether both faces of an edge are in one part.
  bool inside(Index e) const {
    const auto part = [&](int k) {
      return mesh_.flat.part[mesh_.sides[mesh_.edges[e].side[k]].face];
    };
    return !mesh_.edges[e].boundary() && part(0) == part(1);
  }

  void measure(Index f) {
    const Face& face = mesh_.faces[f];
    Part& part = part_[mesh_.flat.part[f]];
    ++part.faces;
    for (int s = 0; s < face.size; ++s) {
      if (inside(mesh_.sides[std::size_t(face.first_side + s)].edge)) continue;
      part.in_metric += flat_[f].length[s];
      part.in_space +=
          (mesh_.positions[face.vertex[(s + 1) % face.size]] - mesh_.positions[face.vertex[s]])
              .norm();
    }
  }

  void set(Index f, double scale) {
    flat_[f] = flat_face(mesh_, mesh_.faces[f], {1.0, 1.0}, 1);
    for (double& length : flat_[f].length) length *= scale;
    flat_[f].area *= scale * scale;
  }

  const ControlMesh& mesh_;
  std::vector<FlatFace>& flat_;
  std::vector<Part> part_;  // by their first faces
};

}  // namespace

std::vector<FlatFace> flatten(const ControlMesh& mesh, double exponent) {
  std::vector<FlatFace> flat;
  flat.reserve(mesh.faces.size());
  const std::vector<std::array<double, 2>> shares = ridge_shares(mesh, exponent);
  for (const Face& face : mesh.faces) {
    stop_if_cancelled(flat.size());
    flat.push_back(flat_face(mesh, face, shares[flat.size()], exponent));
  }
  if (!mesh.flat.face.empty()) FlatShapes(mesh, flat).keep();
  return flat;
}

double edge_length(const ControlMesh& mesh, const std::vector<FlatFace>& flat, Index edge) {
  double sum = 0;
  int count = 0;
  for (const Index s : mesh.edges[edge].side) {
    if (s < 0) continue;
    const Side& side = mesh.sides[s];
    sum += flat[side.face].length[side.local];
    ++count;
  }
  return sum / count;
}

}  // namespace fairing
