// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <string>
#include <unordered_set>

#include "base/error.h"
#include "mesh/fill/fill.h"
#include "mesh/fill/rims.h"

namespace fairing {
namespace {

// Corners of a hole with its islands, as the message has it.
constexpr std::size_t longest_hole = 16'384;

std::string named(std::size_t hole) { return "Hole " + std::to_string(hole); }

void require_vertices(const Hole& hole, std::size_t number, std::int64_t count) {
  if (hole.empty() ||
      std::any_of(hole.begin(), hole.end(), [](const HoleLoop& loop) { return loop.size() < 3; }))
    throw FairingError(ErrorCode::bad_option,
                       named(number) + " has a loop of fewer than three vertices.");
  std::size_t corners = 0;
  std::unordered_set<std::int64_t> seen;
  for (const HoleLoop& loop : hole)
    for (const std::int64_t v : loop) {
      ++corners;
      if (v < 0 || v >= count)
        throw FairingError(ErrorCode::index_out_of_range,
                           named(number) + " names vertex " + std::to_string(v) +
                               ", which does not exist: ids run from 0 to " +
                               std::to_string(count - 1) + ".",
                           {v}, ElementKind::vertex);
      if (!seen.insert(v).second)
        throw FairingError(ErrorCode::repeated_vertex,
                           named(number) + " comes by vertex " + std::to_string(v) +
                               " twice. Cut it there into two holes.",
                           {v}, ElementKind::vertex);
    }
  if (corners > longest_hole)
    throw FairingError(ErrorCode::too_large, named(number) + " has " + std::to_string(corners) +
                                                 " vertices; more than 16,384 cannot be filled.");
}

// The first side that is on no border in this direction, as its two ends; empty: all are.
std::vector<std::int64_t> first_missing(const HoleLoop& loop, const Rims& rims) {
  for (std::size_t i = 0; i < loop.size(); ++i) {
    const std::int64_t a = loop[i], b = loop[(i + 1) % loop.size()];
    if (!rims.is_border(b, a)) return {a, b};
  }
  return {};
}

[[noreturn]] void refuse(std::size_t number, const std::vector<std::int64_t>& edge,
                         const Rims& rims) {
  const std::string begin =
      named(number) + ": the edge " + std::to_string(edge[0]) + "-" + std::to_string(edge[1]);
  const std::string why = !rims.are_joined(edge[0], edge[1]) ? " is none of the mesh"
                          : rims.is_border(edge[0], edge[1]) || rims.is_border(edge[1], edge[0])
                              ? " has its face on the other side than the edges before it"
                              : " has faces on both sides";
  throw FairingError(ErrorCode::bad_option,
                     begin + why + ". A hole is a closed walk along edges of one face each.", edge,
                     ElementKind::edge);
}

void require_manifold(const HoleLoop& loop, std::size_t number, const HalfEdges& half_edges) {
  const std::unordered_set<std::int64_t> on_loop(loop.begin(), loop.end());
  const std::vector<std::int64_t>& torn = half_edges.nonmanifold_edges();
  std::vector<std::int64_t> found;
  for (std::size_t i = 0; i + 1 < torn.size(); i += 2)
    if (on_loop.contains(torn[i]) || on_loop.contains(torn[i + 1]))
      found.insert(found.end(), {torn[i], torn[i + 1]});
  if (!found.empty())
    throw FairingError(ErrorCode::nonmanifold_edge,
                       named(number) + ": " + listing_pairs(edge_s, found, {"has", "have"}) +
                           " more than two faces at its rim. Delete the faces that are too many.",
                       found);
}

}  // namespace

std::vector<Hole> checked_holes(const PolygonMesh& mesh, const HalfEdges& half_edges,
                                std::vector<Hole> holes) {
  for (std::size_t h = 0; h < holes.size(); ++h) require_vertices(holes[h], h, mesh.vertex_count());
  const Rims rims(mesh, half_edges, holes);
  std::unordered_set<std::uint64_t> used;
  for (std::size_t h = 0; h < holes.size(); ++h)
    for (HoleLoop& loop : holes[h]) {
      require_manifold(loop, h, half_edges);
      const std::vector<std::int64_t> missing = first_missing(loop, rims);
      if (!missing.empty()) {
        std::reverse(loop.begin() + 1, loop.end());
        if (!first_missing(loop, rims).empty()) refuse(h, missing, rims);
      }
      std::rotate(loop.begin(), std::min_element(loop.begin(), loop.end()), loop.end());
      for (std::size_t i = 0; i < loop.size(); ++i) {
        const std::int64_t a = loop[i], b = loop[(i + 1) % loop.size()];
        if (!used.insert(Rims::side(a, b)).second)
          throw FairingError(ErrorCode::bad_option,
                             named(h) + " has the edge " + std::to_string(a) + "-" +
                                 std::to_string(b) + " of another hole. Name each hole once.",
                             {a, b}, ElementKind::edge);
      }
    }
  return holes;
}

}  // namespace fairing
