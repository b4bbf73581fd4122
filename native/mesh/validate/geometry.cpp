// SPDX-License-Identifier: GPL-3.0-or-later
#include <Eigen/Geometry>
#include <algorithm>
#include <bit>

#include "base/mixed.h"
#include "base/points.h"
#include "base/roundoff.h"
#include "mesh/validate/checks.h"
#include "parallel/cancel.h"

namespace fairing {
namespace {

using Ids = std::vector<std::int64_t>;

// For every vertex the first vertex with the same coordinates, mostly itself. Linear time.
std::vector<std::int32_t> first_at_same_point(std::span<const double> coordinates) {
  const std::size_t vertices = coordinates.size() / 3;
  const std::size_t mask = std::bit_ceil(2 * vertices + 1) - 1;
  std::vector<std::int32_t> table(mask + 1, -1), first(vertices);
  for (const std::size_t v : Cancellable(vertices)) {
    const double* p = &coordinates[3 * v];
    for (std::size_t slot = hash_of(p) & mask;; slot = (slot + 1) & mask) {
      if (table[slot] < 0) table[slot] = std::int32_t(v);
      const double* q = &coordinates[3 * std::size_t(table[slot])];
      if (p[0] != q[0] || p[1] != q[1] || p[2] != q[2]) continue;
      first[v] = table[slot];
      break;
    }
  }
  return first;
}

}  // namespace

bool has_no_area(std::span<const double> coordinates, std::span<const std::int64_t> face) {
  const auto point = [&](std::size_t i) { return point_at(coordinates, face[i]); };
  // Relative to one corner, as rounding is too large for a small face far from the origin.
  const Vec3 origin = point(0);
  Vec3 twice_area = Vec3::Zero(), last = point(face.size() - 1) - origin;
  double longest = 0;
  for (std::size_t i = 0; i < face.size(); ++i) {
    const Vec3 here = point(i) - origin;
    twice_area += last.cross(here);
    longest = std::max(longest, (here - last).squaredNorm());
    last = here;
  }
  return !(twice_area.norm() > 2 * roundoff * longest);  // also true for NaN
}

void check_coincident_vertices(const PolygonMesh& mesh, Defects& found) {
  const std::vector<std::int32_t> first = first_at_same_point(mesh.coordinates);
  const std::vector<std::uint8_t> used = used_vertices(mesh);

  Ids shared;
  std::vector<std::uint8_t> listed(first.size(), 0);
  const auto add = [&](std::size_t v) {
    if (!listed[v]) shared.push_back(std::int64_t(v));
    listed[v] = 1;
  };
  // A group's leader is its first *used* vertex, so that isolated ones are not reported twice.
  std::vector<std::int32_t> leader(first.size(), -1);
  for (const std::size_t v : Cancellable(first.size())) {
    if (!used[v]) continue;
    auto& lead = leader[first[v]];
    if (lead >= 0) {
      add(std::size_t(lead));
      add(v);
    } else {
      lead = std::int32_t(v);
    }
  }
  if (shared.empty()) return;

  Ids touching;
  for (const std::int64_t f : Cancellable(mesh.face_count())) {
    const auto face = mesh.face(f);
    for (std::size_t i = 0; i < face.size(); ++i) {
      if (!listed[face[i]]) continue;
      for (std::size_t j = 0; j < i; ++j)
        if (face[i] != face[j] && first[face[i]] == first[face[j]])
          touching.insert(touching.end(), {face[i], face[j]});
    }
  }
  std::sort(touching.begin(), touching.end());
  touching.erase(std::unique(touching.begin(), touching.end()), touching.end());
  if (!touching.empty())
    found.emplace_back(ErrorCode::coincident_vertices,
                       Message{"{vertex} {lies|lie} exactly on another vertex of the same face.",
                               "Merge them by distance."},
                       touching);

  std::erase_if(shared, [&](std::int64_t v) {
    return std::binary_search(touching.begin(), touching.end(), v);
  });
  if (shared.empty()) return;
  std::sort(shared.begin(), shared.end());
  found.emplace_back(ErrorCode::coincident_vertices,
                     Message{"{vertex} {shares|share} a point with others without being joined to "
                             "them: the surface is open there.",
                             "Merge by distance if it should be closed."},
                     shared, Severity::warning);
}

void check_areas(const PolygonMesh& mesh, Defects& found) {
  const Ids bad = faces_where(mesh, [&](auto face) { return has_no_area(mesh.coordinates, face); });
  if (bad.empty()) return;
  found.emplace_back(ErrorCode::degenerate_face,
                     Message{"{face} {has|have} no area.", "Dissolve or delete them."}, bad);
}

void warn_of_isolated_vertices(const PolygonMesh& mesh, Defects& found) {
  const std::vector<std::uint8_t> used = used_vertices(mesh);
  Ids isolated;
  for (std::size_t v = 0; v < used.size(); ++v)
    if (!used[v]) isolated.push_back(std::int64_t(v));
  if (isolated.empty()) return;
  found.emplace_back(ErrorCode::isolated_vertices,
                     "{vertex} {belongs|belong} to no face and {stays|stay} in place.", isolated,
                     Severity::warning);
}

}  // namespace fairing
