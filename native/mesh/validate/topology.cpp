// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>

#include "base/mixed.h"
#include "mesh/counting_sort.h"
#include "mesh/validate/checks.h"
#include "parallel/cancel.h"

namespace fairing {
namespace {

using Ids = std::vector<std::int64_t>;

struct Fingerprint {
  std::uint64_t hash;  // of the set of vertices: a sum, which does not depend on their order
  std::int32_t face;
};

Ids sorted_vertices(const PolygonMesh& mesh, std::int32_t f) {
  const auto face = mesh.face(f);
  Ids vertices(face.begin(), face.end());
  std::sort(vertices.begin(), vertices.end());
  return vertices;
}

// Compares the vertices of faces with the same hash.
void collect_equal_sets(const PolygonMesh& mesh, std::span<const Fingerprint> same_hash,
                        std::vector<SameVertices>& found) {
  std::vector<std::pair<Ids, std::int32_t>> sets;
  for (const Fingerprint& print : same_hash)
    sets.emplace_back(sorted_vertices(mesh, print.face), print.face);
  std::sort(sets.begin(), sets.end());
  std::int32_t first = 0;
  for (std::size_t i = 0; i < sets.size(); ++i) {
    const bool as_before = i > 0 && sets[i - 1].first == sets[i].first;
    const bool as_after = i + 1 < sets.size() && sets[i].first == sets[i + 1].first;
    if (!as_before) first = sets[i].second;
    if (as_before || as_after) found.push_back({sets[i].second, first});
  }
}

std::int32_t fan_size(const HalfEdges& half_edges, std::int32_t k) {
  std::int32_t size = 0;
  half_edges.visit_fan(k, [&](std::int32_t, bool) { ++size; });
  return size;
}

}  // namespace

std::vector<SameVertices> faces_with_same_vertices(const PolygonMesh& mesh) {
  // Sorting faces by their lowest vertices gives groups of two on average.
  const auto lowest = [&](std::size_t f) { return std::ranges::min(mesh.face(std::int64_t(f))); };
  const auto print_of = [&](std::size_t f) {
    Fingerprint print{0, std::int32_t(f)};
    for (std::int64_t v : mesh.face(print.face)) print.hash += mixed(std::uint64_t(v));
    return print;
  };
  CountingSort<Fingerprint> fingerprints(std::size_t(mesh.vertex_count()),
                                         std::size_t(mesh.face_count()), lowest, print_of);
  std::vector<SameVertices> found;
  fingerprints.for_equal([](const Fingerprint& a, const Fingerprint& b) { return a.hash < b.hash; },
                         [&](std::span<const Fingerprint> same_hash) {
                           if (same_hash.size() > 1) collect_equal_sets(mesh, same_hash, found);
                         });
  std::sort(found.begin(), found.end(),
            [](const SameVertices& a, const SameVertices& b) { return a.face < b.face; });
  return found;
}

void check_duplicate_faces(const PolygonMesh& mesh, Defects& found) {
  Ids duplicates;
  for (const SameVertices& same : faces_with_same_vertices(mesh)) duplicates.push_back(same.face);
  if (duplicates.empty()) return;
  found.emplace_back(ErrorCode::duplicate_face,
                     Message{"{face} {has|have} the same vertices as another face.",
                             "Delete all but one of each."},
                     duplicates);
}

void check_nonmanifold_edges(const HalfEdges& half_edges, Defects& found) {
  const Ids& pairs = half_edges.nonmanifold_edges();
  if (pairs.empty()) return;
  found.emplace_back(
      ErrorCode::nonmanifold_edge,
      Message{
          "{edge} {joins|join} more than two faces (vertex pairs): sheets meet there in a curve.",
          "Delete inner faces that you do not want."},
      pairs, Severity::warning);
}

void check_nonmanifold_vertices(const PolygonMesh& mesh, const HalfEdges& half_edges,
                                Defects& found) {
  std::vector<std::int32_t> corners(std::size_t(mesh.vertex_count()), 0), some(corners.size(), -1);
  for (const std::int32_t k : Cancellable(half_edges.count())) {
    const auto v = std::size_t(half_edges.from(k));
    ++corners[v];
    some[v] = k;
  }
  for (std::int64_t v : half_edges.nonmanifold_edges()) corners[v] = 0;
  Ids bad;
  for (const std::size_t v : Cancellable(corners.size())) {
    if (corners[v] > 0 && fan_size(half_edges, some[v]) != corners[v])
      bad.push_back(std::int64_t(v));
  }
  if (bad.empty()) return;
  found.emplace_back(
      ErrorCode::nonmanifold_vertex,
      "{vertex} {joins|join} parts of the surface that share no edge there: they touch in a point.",
      bad, Severity::warning);
}

void check_orientation(const Orientation& orientation, bool repair, Defects& found) {
  const auto& [to_flip, one_sided] = orientation;
  if (!one_sided.empty())
    found.emplace_back(ErrorCode::non_orientable,
                       Message{"{face} {belongs|belong} to a surface with only one side, like a "
                               "Möbius strip: flipping faces cannot help.",
                               "Only the thin plate accepts it; cut it open for other energies."},
                       one_sided, Severity::warning);
  if (!to_flip.empty())
    found.emplace_back(ErrorCode::inconsistent_orientation,
                       Message{"{face} {points|point} against the neighbours.",
                               "Recalculate the normals, or use repair=\"mend\"."},
                       to_flip, repair ? Severity::warning : Severity::error);
}

}  // namespace fairing
