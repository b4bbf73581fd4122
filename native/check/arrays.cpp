// SPDX-License-Identifier: GPL-3.0-or-later
#include "check/arrays.h"

#include <algorithm>
#include <cmath>

#include "check/error.h"
#include "check/listing.h"

namespace fairing {
namespace {

using Ids = std::vector<std::int64_t>;

// Above this, squares and cubes of lengths would overflow later on.
constexpr double largest_coordinate = 1e100;

// A corner becomes up to three sides when its polygon is split, a side up to two half-edges; all ids have
// 32 bits.
constexpr std::size_t most_corners = (std::size_t(1) << 31) / 8;

template <class Predicate>
Ids faces_where(const PolygonMesh& mesh, Predicate predicate) {
  Ids found;
  for (std::int64_t f = 0; f < mesh.face_count(); ++f)
    if (predicate(mesh.face(f))) found.push_back(f);
  return found;
}

bool repeats_a_vertex(std::span<const std::int64_t> face) {
  if (face.size() == 3) return face[0] == face[1] || face[1] == face[2] || face[2] == face[0];
  Ids sorted(face.begin(), face.end());
  std::sort(sorted.begin(), sorted.end());
  return std::adjacent_find(sorted.begin(), sorted.end()) != sorted.end();
}

void check_sizes(const PolygonMesh& mesh) {
  if (mesh.coordinates.empty() && mesh.corners.empty())
    throw FairingError(ErrorCode::empty_mesh, "The mesh has no vertices.");
  if (mesh.coordinates.size() % 3 != 0)
    throw FairingError(ErrorCode::bad_shape, "The coordinates must come in threes: x, y, z for each vertex.");
  if (mesh.offsets.size() < 2 && mesh.corners.empty())
    throw FairingError(ErrorCode::no_faces, "The mesh has no faces: there is no surface to fair.");
  if (mesh.offsets.empty() || mesh.offsets.front() != 0 ||
      mesh.offsets.back() != std::int64_t(mesh.corners.size()) ||
      !std::is_sorted(mesh.offsets.begin(), mesh.offsets.end()))
    throw FairingError(
        ErrorCode::bad_shape,
        "The face offsets must ascend from 0 to the number of corners, one more than there are faces.");
  if (mesh.corners.size() > most_corners || mesh.coordinates.size() / 3 > most_corners)
    throw FairingError(ErrorCode::too_large,
                       "The control mesh has more than 268 million corners or vertices.");
}

void check_corner_counts(const PolygonMesh& mesh) {
  const Ids bad = faces_where(mesh, [](auto face) { return face.size() < 3; });
  if (!bad.empty())
    throw FairingError(ErrorCode::bad_shape,
                       listing(face_s, bad, {"has", "have"}) + " fewer than three corners. Delete them.",
                       bad);
}

void check_finite(const PolygonMesh& mesh) {
  Ids bad;
  const auto& x = mesh.coordinates;
  for (std::size_t v = 0; v < x.size() / 3; ++v) {
    const double size = std::max({std::abs(x[3 * v]), std::abs(x[3 * v + 1]), std::abs(x[3 * v + 2])});
    const bool nan = std::isnan(x[3 * v]) || std::isnan(x[3 * v + 1]) || std::isnan(x[3 * v + 2]);
    if (nan || size > largest_coordinate) bad.push_back(std::int64_t(v));
  }
  if (!bad.empty())
    throw FairingError(ErrorCode::non_finite,
                       listing(vertex_s, bad, {"has", "have"}) +
                           " a coordinate that is NaN, infinite or beyond 1e100. Delete or move them.",
                       bad);
}

void check_indices(const PolygonMesh& mesh) {
  const std::int64_t vertices = mesh.vertex_count();
  const Ids outside = faces_where(mesh, [&](auto face) {
    return std::any_of(face.begin(), face.end(), [&](std::int64_t v) { return v < 0 || v >= vertices; });
  });
  if (!outside.empty())
    throw FairingError(ErrorCode::index_out_of_range,
                       listing(face_s, outside, {"names", "name"}) +
                           " a vertex that does not exist: ids run from 0 to " +
                           std::to_string(vertices - 1) + ".",
                       outside);
  const Ids repeated = faces_where(mesh, repeats_a_vertex);
  if (!repeated.empty())
    throw FairingError(ErrorCode::repeated_vertex,
                       listing(face_s, repeated, {"names", "name"}) +
                           " the same vertex twice. Delete them or dissolve the doubled corner.",
                       repeated);
}

}  // namespace

void check_arrays(const PolygonMesh& mesh) {
  check_sizes(mesh);
  if (mesh.coordinates.empty())
    throw FairingError(ErrorCode::empty_mesh, "The mesh has faces but no vertices.");
  check_corner_counts(mesh);
  check_finite(mesh);
  check_indices(mesh);
}

}  // namespace fairing
