// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <string>
#include <unordered_set>

#include "base/error.h"
#include "mesh/fill/fill.h"
#include "mesh/fill/rims.h"

namespace fairing {
namespace {

void require_vertices(const Hole& hole, std::size_t number, std::int64_t count) {
  const std::string named = "Hole " + std::to_string(number);
  if (hole.empty() ||
      std::any_of(hole.begin(), hole.end(), [](const HoleLoop& loop) { return loop.size() < 3; }))
    throw FairingError(ErrorCode::bad_option, named + " has a loop of fewer than three vertices.");
  for (const HoleLoop& loop : hole)
    for (const std::int64_t v : loop)
      if (v < 0 || v >= count)
        throw FairingError(ErrorCode::index_out_of_range,
                           named + " names {vertex}, which does not exist: ids run from 0 to " +
                               std::to_string(count - 1) + ".",
                           {v}, ElementKind::vertex);
}

void require_simple(const Hole& hole) {
  std::unordered_set<std::int64_t> seen;
  for (const HoleLoop& loop : hole)
    for (const std::int64_t v : loop)
      if (!seen.insert(v).second)
        throw FairingError(ErrorCode::repeated_vertex,
                           {"The rim passes {vertex} twice.", "Cut it there into two holes."}, {v},
                           ElementKind::vertex);
  if (seen.size() > longest_hole)
    throw FairingError(ErrorCode::too_large, too_long_text(seen.size()));
}

// The first side that is not on a border in this direction, or with `in_any` in either one, as its
// two ends; empty if there is none.
std::vector<std::int64_t> first_missing(const HoleLoop& loop, const Rims& rims, bool in_any) {
  for (std::size_t i = 0; i < loop.size(); ++i) {
    const std::int64_t a = loop[i], b = loop[(i + 1) % loop.size()];
    if (!rims.is_border(b, a) && !(in_any && rims.is_border(a, b))) return {a, b};
  }
  return {};
}

[[noreturn]] void refuse(const HoleLoop& loop, const Rims& rims) {
  std::vector<std::int64_t> edge = first_missing(loop, rims, true);
  if (edge.empty()) edge = first_missing(loop, rims, false);
  if (rims.is_border(edge[0], edge[1]))
    throw FairingError(
        ErrorCode::inconsistent_orientation,
        {"Faces at {edge} of the rim point different ways.", "Recalculate their normals."}, edge,
        ElementKind::edge);
  const std::string why = rims.are_joined(edge[0], edge[1]) ? "{has|have} faces on both sides"
                                                            : "{is|are} not in the mesh";
  throw FairingError(
      ErrorCode::bad_option,
      {"{edge} of the rim " + why + ".", "A hole is a closed walk along edges of one face each."},
      edge, ElementKind::edge);
}

void require_manifold(const HoleLoop& loop, const HalfEdges& half_edges) {
  const std::unordered_set<std::int64_t> on_loop(loop.begin(), loop.end());
  const std::vector<std::int64_t>& torn = half_edges.nonmanifold_edges();
  std::vector<std::int64_t> found;
  for (std::size_t i = 0; i + 1 < torn.size(); i += 2)
    if (on_loop.contains(torn[i]) || on_loop.contains(torn[i + 1]))
      found.insert(found.end(), {torn[i], torn[i + 1]});
  if (!found.empty())
    throw FairingError(
        ErrorCode::nonmanifold_edge,
        {"More than two faces meet at {edge} of the rim.", "Delete the surplus faces."}, found);
}

// Each side may be on one loop only.
using Used = std::unordered_set<std::uint64_t>;

void check_loop(HoleLoop& loop, const HalfEdges& half_edges, const Rims& rims, const Used& used) {
  require_manifold(loop, half_edges);
  if (!first_missing(loop, rims, false).empty()) {
    std::reverse(loop.begin() + 1, loop.end());
    if (!first_missing(loop, rims, false).empty()) {
      std::reverse(loop.begin() + 1, loop.end());
      refuse(loop, rims);
    }
  }
  std::rotate(loop.begin(), std::min_element(loop.begin(), loop.end()), loop.end());
  for (std::size_t i = 0; i < loop.size(); ++i) {
    const std::int64_t a = loop[i], b = loop[(i + 1) % loop.size()];
    if (used.contains(Rims::side(a, b)))
      throw FairingError(
          ErrorCode::bad_option,
          {"{edge} of the rim {belongs|belong} to another hole too.", "Name each hole once."},
          {a, b}, ElementKind::edge);
  }
}

}  // namespace

Refusals check_holes(const PolygonMesh& mesh, const HalfEdges& half_edges,
                     std::vector<Hole>& holes) {
  for (std::size_t h = 0; h < holes.size(); ++h) require_vertices(holes[h], h, mesh.vertex_count());
  const Rims rims(mesh, half_edges, holes);
  Used used;
  Refusals refusals(holes.size());
  for (std::size_t h = 0; h < holes.size(); ++h) try {
      require_simple(holes[h]);
      for (HoleLoop& loop : holes[h]) check_loop(loop, half_edges, rims, used);
      std::sort(holes[h].begin(), holes[h].end());
      for (const HoleLoop& loop : holes[h])
        for (std::size_t i = 0; i < loop.size(); ++i)
          used.insert(Rims::side(loop[i], loop[(i + 1) % loop.size()]));
    } catch (const FairingError& error) {
      refusals[h] = error;
    }
  return refusals;
}

}  // namespace fairing
