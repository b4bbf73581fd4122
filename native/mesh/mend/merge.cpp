// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/mend/merge.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "base/mixed.h"
#include "base/points.h"
#include "base/roundoff.h"
#include "mesh/validate/checks.h"
#include "parallel/cancel.h"

namespace fairing {
namespace {

using Ids = std::vector<std::int64_t>;

Vec3 point(const PolygonMesh& mesh, std::int64_t v) { return point_at(mesh.coordinates, v); }

// Kept vertices by the cube of space that contains them, in a hash table with chains.
class Cubes {
 public:
  Cubes(std::size_t points, double side)
      : side_(side), first_(std::bit_ceil(points + 1), -1), next_(points, -1) {}

  std::array<double, 3> at(const Vec3& p) const {
    return {std::floor(p[0] / side_), std::floor(p[1] / side_), std::floor(p[2] / side_)};
  }
  void add(Index v, const Vec3& p) {
    Index& first = first_[slot(at(p))];
    next_[v] = first;
    first = v;
  }
  // Calls visit(v) for every vertex in a cube, and possibly for others.
  template <class Visit>
  void visit(const std::array<double, 3>& cube, Visit&& visit) const {
    for (Index v = first_[slot(cube)]; v >= 0; v = next_[v]) visit(v);
  }

 private:
  std::size_t slot(const std::array<double, 3>& cube) const {
    return std::size_t(hash_of(cube.data())) & (first_.size() - 1);
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

// A face with merged vertices; consecutive repetitions are removed.
void current_face(const PolygonMesh& mesh, std::int64_t f, UnionFind& merges, Ids& face) {
  face.clear();
  for (const std::int64_t v : mesh.face(f)) {
    const std::int64_t lead = merges.lead(Index(v));
    if (face.empty() || face.back() != lead) face.push_back(lead);
  }
  while (face.size() > 1 && face.front() == face.back()) face.pop_back();
}

bool unite_touching(const PolygonMesh& mesh, const Ids& face, UnionFind& merges) {
  bool any = false;
  Ids sorted = face;
  std::sort(sorted.begin(), sorted.end(), [&](std::int64_t a, std::int64_t b) {
    const Vec3 p = point(mesh, a), q = point(mesh, b);
    return std::lexicographical_compare(p.data(), p.data() + 3, q.data(), q.data() + 3);
  });
  for (std::size_t i = 1; i < sorted.size(); ++i) {
    const std::int64_t a = sorted[i - 1], b = sorted[i];
    if (a != b && point(mesh, a) == point(mesh, b)) any |= merges.unite(Index(a), Index(b));
  }
  return any;
}

bool unite_short_sides(const PolygonMesh& mesh, const Ids& face, UnionFind& merges) {
  if (face.size() < 3 || !has_no_area(mesh.coordinates, face)) return false;
  const auto side = [&](std::size_t i) {
    return (point(mesh, face[i]) - point(mesh, face[(i + 1) % face.size()])).norm();
  };
  double longest = 0;
  for (std::size_t i = 0; i < face.size(); ++i) longest = std::max(longest, side(i));
  bool any = false;
  for (std::size_t i = 0; i < face.size(); ++i) {
    if (!(side(i) <= roundoff * longest)) continue;
    merges.unite(Index(face[i]), Index(face[(i + 1) % face.size()]));
    any = true;
  }
  return any;
}

}  // namespace

bool merge_near(const PolygonMesh& mesh, double distance, UnionFind& merges) {
  const std::vector<std::uint8_t> used = used_vertices(mesh);
  // Cubes as small as rounding errors would be too many to number.
  using Limits = std::numeric_limits<double>;
  const double side =
      std::max({distance, Limits::epsilon() * largest_coordinate_of(mesh, used), Limits::min()});
  Cubes cubes(used.size(), side);
  bool any = false;
  for (const std::size_t v : Cancellable(used.size())) {
    if (!used[v]) continue;
    const Vec3 p = point(mesh, std::int64_t(v));
    const auto cube = cubes.at(p);
    Index lowest = Index(v);
    const auto look_at = [&](Index u) {
      if (u < lowest && (point(mesh, u) - p).norm() <= distance) lowest = u;
    };
    for (const double x : {-1.0, 0.0, 1.0})
      for (const double y : {-1.0, 0.0, 1.0})
        for (const double z : {-1.0, 0.0, 1.0})
          cubes.visit({cube[0] + x, cube[1] + y, cube[2] + z}, look_at);
    if (lowest < Index(v))
      any |= merges.unite(lowest, Index(v));
    else
      cubes.add(Index(v), p);
  }
  return any;
}

// A merge may leave another side without length, which the next round finds.
bool merge_within_faces(const PolygonMesh& mesh, UnionFind& merges) {
  Ids face;
  bool any = false;
  for (bool again = true; again;) {
    again = false;
    for (const std::int64_t f : Cancellable(mesh.face_count())) {
      if (names_absent_vertex(mesh.face(f), mesh.vertex_count())) continue;
      current_face(mesh, f, merges, face);
      if (unite_touching(mesh, face, merges) || unite_short_sides(mesh, face, merges))
        any = again = true;
    }
  }
  return any;
}

}  // namespace fairing
