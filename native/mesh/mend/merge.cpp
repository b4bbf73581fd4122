// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/mend/merge.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>

#include "mesh/validate/checks.h"
#include "parallel/cancel.h"

namespace fairing {
namespace {

using Ids = std::vector<std::int64_t>;

// In a face without area, of its longest side: a shorter side has no length.
constexpr double least_side = 1e-9;

Vec3 point(const PolygonMesh& mesh, std::int64_t v) {
  return Eigen::Map<const Vec3>(&mesh.coordinates[3 * std::size_t(v)]);
}

// Kept vertices by the cube of space that they are in, in a table of chains.
class Cubes {
 public:
  Cubes(std::size_t points, double side)
      : side_(side), first_(std::bit_ceil(points + 1), -1), next_(points, -1) {}

  std::array<double, 3> at(const Vec3& p) const {
    return {std::floor(p[0] / side_), std::floor(p[1] / side_), std::floor(p[2] / side_)};
  }
  void add(Index v, const Vec3& p) {
    Index& first = first_[slot(at(p))];
    next_[std::size_t(v)] = first;
    first = v;
  }
  // Calls visit(v) for every vertex in a cube, and perhaps for others.
  template <class Visit>
  void visit(const std::array<double, 3>& cube, Visit&& visit) const {
    for (Index v = first_[slot(cube)]; v >= 0; v = next_[std::size_t(v)]) visit(v);
  }

 private:
  std::size_t slot(const std::array<double, 3>& cube) const {
    std::uint64_t h = 0;
    for (const double value : cube) {
      h = (h ^ std::bit_cast<std::uint64_t>(value + 0.0)) * 0x9e3779b97f4a7c15u;
      h ^= h >> 29;
    }
    return std::size_t(h) & (first_.size() - 1);
  }
  double side_;
  Array<Index> first_, next_;
};

double largest_coordinate_of(const PolygonMesh& mesh, const std::vector<std::uint8_t>& used) {
  double largest = 0;
  for (std::size_t v = 0; v < used.size(); ++v)
    if (used[v]) largest = std::max(largest, point(mesh, std::int64_t(v)).cwiseAbs().maxCoeff());
  return largest;
}

// A face with its vertices as they are now, each once where it comes twice in a row.
void current_face(const PolygonMesh& mesh, std::int64_t f, Merges& merges, Ids& face) {
  face.clear();
  for (const std::int64_t v : mesh.face(f)) {
    const std::int64_t lead = merges.lead(Index(v));
    if (face.empty() || face.back() != lead) face.push_back(lead);
  }
  while (face.size() > 1 && face.front() == face.back()) face.pop_back();
}

bool unite_touching(const PolygonMesh& mesh, const Ids& face, Merges& merges) {
  bool any = false;
  const auto unite_if_same = [&](std::int64_t a, std::int64_t b) {
    if (a == b || point(mesh, a) != point(mesh, b)) return;
    merges.unite(Index(a), Index(b));
    any = true;
  };
  if (face.size() <= 8) {
    for (std::size_t i = 0; i < face.size(); ++i)
      for (std::size_t j = 0; j < i; ++j) unite_if_same(face[i], face[j]);
    return any;
  }
  Ids sorted = face;
  std::sort(sorted.begin(), sorted.end(), [&](std::int64_t a, std::int64_t b) {
    const Vec3 p = point(mesh, a), q = point(mesh, b);
    return std::lexicographical_compare(p.data(), p.data() + 3, q.data(), q.data() + 3);
  });
  for (std::size_t i = 1; i < sorted.size(); ++i) unite_if_same(sorted[i - 1], sorted[i]);
  return any;
}

bool unite_short_sides(const PolygonMesh& mesh, const Ids& face, Merges& merges) {
  if (face.size() < 3 || !has_no_area(mesh.coordinates, face)) return false;
  const auto side = [&](std::size_t i) {
    return (point(mesh, face[i]) - point(mesh, face[(i + 1) % face.size()])).norm();
  };
  double longest = 0;
  for (std::size_t i = 0; i < face.size(); ++i) longest = std::max(longest, side(i));
  bool any = false;
  for (std::size_t i = 0; i < face.size(); ++i) {
    if (!(side(i) <= least_side * longest)) continue;
    merges.unite(Index(face[i]), Index(face[(i + 1) % face.size()]));
    any = true;
  }
  return any;
}

}  // namespace

Merges::Merges(std::size_t vertices) : lead_(vertices) {
  std::iota(lead_.begin(), lead_.end(), Index(0));
}

void Merges::unite(Index a, Index b) {
  const Index la = lead(a), lb = lead(b), lowest = std::min(la, lb);
  any_ |= la != lb;
  lead_[std::size_t(la)] = lead_[std::size_t(lb)] = lowest;
}

void weld(const PolygonMesh& mesh, double distance, Merges& merges) {
  const std::vector<std::uint8_t> used = used_vertices(mesh);
  // Cubes of rounding errors' size would be without number.
  const double side = std::max({distance, 1e-15 * largest_coordinate_of(mesh, used), 1e-300});
  Cubes cubes(used.size(), side);
  for (std::size_t v = 0; v < used.size(); ++v) {
    stop_if_cancelled(v);
    if (!used[v]) continue;
    const Vec3 p = point(mesh, std::int64_t(v));
    const auto cube = cubes.at(p);
    Index lowest = Index(v);
    for (int k = 0; k < 27; ++k)
      cubes.visit({cube[0] + k % 3 - 1, cube[1] + k / 3 % 3 - 1, cube[2] + k / 9 - 1},
                  [&](Index u) {
                    if (u < lowest && (point(mesh, u) - p).norm() <= distance) lowest = u;
                  });
    if (lowest < Index(v))
      merges.unite(lowest, Index(v));
    else
      cubes.add(Index(v), p);
  }
}

// What was merged may leave another side without length, in the next round.
void merge_within_faces(const PolygonMesh& mesh, Merges& merges) {
  Ids face;
  for (bool again = true; again;) {
    again = false;
    for (std::int64_t f = 0; f < mesh.face_count(); ++f) {
      stop_if_cancelled(std::size_t(f));
      if (names_absent_vertex(mesh.face(f), mesh.vertex_count())) continue;
      current_face(mesh, f, merges, face);
      if (unite_touching(mesh, face, merges) || unite_short_sides(mesh, face, merges)) again = true;
    }
  }
}

}  // namespace fairing
