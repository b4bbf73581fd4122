// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>

#include "mesh/validate/checks.h"

namespace fairing {
namespace {

using Ids = std::vector<std::int64_t>;

// Squares and cubes of larger lengths overflow.
constexpr double largest_coordinate = 1e100;

// A split gives a corner up to three sides, and a side two half-edges; all ids have 32 bits.
constexpr std::size_t largest_mesh = (std::size_t(1) << 31) / 8;

bool cut_faces(std::span<const std::int64_t> offsets, std::size_t corners) {
  return !offsets.empty() && offsets.front() == 0 && offsets.back() == std::int64_t(corners) &&
         std::is_sorted(offsets.begin(), offsets.end());
}

Defect bad_offsets() {
  return Defect(
      ErrorCode::bad_shape,
      "The face offsets must increase from 0 to the number of corners, one more than there "
      "are faces.");
}

Defect too_many() {
  return Defect(ErrorCode::too_large,
                "The control mesh has more than 268 million corners or vertices.");
}

// Checks that the sizes agree, so that every face's span of corners exists.
bool check_sizes(const PolygonMesh& mesh, Defects& found) {
  const std::size_t before = found.size();
  if (mesh.coordinates.empty() && mesh.corners.empty())
    found.emplace_back(ErrorCode::empty_mesh, "The mesh has no vertices.");
  else if (mesh.coordinates.size() % 3 != 0)
    found.emplace_back(ErrorCode::bad_shape,
                       "The coordinates must be triples: x, y, z for each vertex.");
  else if (mesh.offsets.size() < 2 && mesh.corners.empty())
    found.emplace_back(ErrorCode::no_faces, "The mesh has no faces: there is no surface to fair.");
  else if (!cut_faces(mesh.offsets, mesh.corners.size()))
    found.push_back(bad_offsets());
  else if (mesh.corners.size() > largest_mesh || mesh.coordinates.size() / 3 > largest_mesh)
    found.push_back(too_many());
  else if (mesh.coordinates.empty())
    found.emplace_back(ErrorCode::empty_mesh, "The mesh has faces but no vertices.");
  return found.size() == before;
}

bool check_corner_counts(const PolygonMesh& mesh, Defects& found) {
  const Ids bad = faces_where(mesh, [](auto face) { return face.size() < 3; });
  if (!bad.empty())
    found.emplace_back(ErrorCode::bad_shape,
                       Message{"{face} {has|have} fewer than three corners.", "Delete them."}, bad);
  return bad.empty();
}

bool check_finite(const PolygonMesh& mesh, Defects& found) {
  const Ids bad = non_finite_vertices(mesh.coordinates);
  if (bad.empty()) return true;
  found.emplace_back(
      ErrorCode::non_finite,
      Message{"{vertex} {has|have} a coordinate that is NaN, infinite or beyond 1e100.",
              "Delete or move them."},
      bad);
  const std::vector<std::uint8_t> used = used_vertices(mesh);
  found.back().repairable =
      std::none_of(bad.begin(), bad.end(), [&](std::int64_t v) { return used[v]; });
  return false;
}

// A hint if the ids are 1 to the number of vertices.
std::string counts_from_one(const PolygonMesh& mesh) {
  const auto [lowest, highest] = std::minmax_element(mesh.corners.begin(), mesh.corners.end());
  if (*lowest != 1 || *highest != mesh.vertex_count()) return "";
  return " These seem to count from 1: subtract 1 from all of them.";
}

bool check_range(const PolygonMesh& mesh, Defects& found) {
  const std::int64_t vertices = mesh.vertex_count();
  const Ids outside =
      faces_where(mesh, [&](auto face) { return names_absent_vertex(face, vertices); });
  if (outside.empty()) return true;
  found.emplace_back(ErrorCode::index_out_of_range,
                     "{face} {names|name} a vertex that does not exist: ids run from 0 to " +
                         std::to_string(vertices - 1) + "." + counts_from_one(mesh),
                     outside);
  found.back().repairable = std::int64_t(outside.size()) < mesh.face_count();
  return false;
}

bool check_repetition(const PolygonMesh& mesh, Defects& found) {
  const Ids repeated =
      faces_where(mesh, [](auto face) { return face.size() >= 3 && repeats_a_vertex(face); });
  if (!repeated.empty())
    found.emplace_back(ErrorCode::repeated_vertex,
                       Message{"{face} {names|name} the same vertex twice.",
                               "Delete them or dissolve the doubled corner."},
                       repeated);
  return repeated.empty();
}

}  // namespace

bool repeats_a_vertex(std::span<const std::int64_t> face) {
  if (face.size() == 3) return face[0] == face[1] || face[1] == face[2] || face[2] == face[0];
  Ids sorted(face.begin(), face.end());
  std::sort(sorted.begin(), sorted.end());
  return std::adjacent_find(sorted.begin(), sorted.end()) != sorted.end();
}

bool names_absent_vertex(std::span<const std::int64_t> face, std::int64_t vertices) {
  return std::any_of(face.begin(), face.end(),
                     [&](std::int64_t v) { return v < 0 || v >= vertices; });
}

std::vector<std::uint8_t> used_vertices(const PolygonMesh& mesh) {
  std::vector<std::uint8_t> used(std::size_t(mesh.vertex_count()), 0);
  for (const std::int64_t f : Cancellable(mesh.face_count())) {
    const auto face = mesh.face(f);
    if (names_absent_vertex(face, mesh.vertex_count())) continue;
    for (const std::int64_t v : face) used[v] = 1;
  }
  return used;
}

std::vector<std::int64_t> non_finite_vertices(std::span<const double> x) {
  Ids bad;
  for (const std::size_t v : Cancellable(x.size() / 3)) {
    const double size =
        std::max({std::abs(x[3 * v]), std::abs(x[3 * v + 1]), std::abs(x[3 * v + 2])});
    const bool nan = std::isnan(x[3 * v]) || std::isnan(x[3 * v + 1]) || std::isnan(x[3 * v + 2]);
    if (nan || size > largest_coordinate) bad.push_back(std::int64_t(v));
  }
  return bad;
}

void require_faces(std::span<const std::int64_t> corners, std::span<const std::int64_t> offsets) {
  if (!cut_faces(offsets, corners.size())) bad_offsets().raise();
  if (corners.size() > largest_mesh) too_many().raise();
}

void require_arrays(const PolygonMesh& mesh) {
  Defects found;
  check_arrays(mesh, found);
  if (!found.empty()) found.front().raise();
}

Readable check_arrays(const PolygonMesh& mesh, Defects& found) {
  Readable readable;
  if (!check_sizes(mesh, found)) return readable;
  const bool enough_corners = check_corner_counts(mesh, found);
  readable.coordinates = check_finite(mesh, found);
  const bool in_range = check_range(mesh, found);
  const bool no_repetition = check_repetition(mesh, found);
  readable.faces = enough_corners && in_range;
  readable.simple = readable.faces && no_repetition;
  return readable;
}

}  // namespace fairing
