// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/sheets.h"

#include <algorithm>

#include "mesh/half_edges.h"
#include "mesh/union_find.h"
#include "parallel/cancel.h"

namespace fairing {
namespace {

// A vertex to add, for a fan or above that of a fan on a double cover.
struct Copy {
  std::int64_t of;
  std::int32_t corner;  // a corner of the fan
  bool second;
  auto operator<=>(const Copy&) const = default;
};

// For all fans but the first of each vertex, and above all fans of one-sided sheets; ascending.
std::vector<Copy> copies_wanted(const HalfEdges& half_edges, std::size_t vertices,
                                const DoubleCover& cover) {
  std::vector<Copy> copies;
  std::vector<std::uint8_t> seen(std::size_t(half_edges.count()), 0), met(vertices, 0);
  for (const std::int32_t k : Cancellable(half_edges.count())) {
    if (seen[k]) continue;
    half_edges.visit_fan(k, [&](std::int32_t corner, bool) { seen[corner] = 1; });
    const std::int64_t v = half_edges.from(k);
    if (met[v]) copies.push_back({v, k, false});
    if (cover.has(half_edges.face(k))) copies.push_back({v, k, true});
    met[v] = 1;
  }
  std::sort(copies.begin(), copies.end());
  return copies;
}

// Edges between the same two vertices: pairs of the first one and each copy, ascending. Only cut
// edges and those on a double cover are repeated, since splits never join two vertices again.
std::vector<std::array<Index, 2>> edges_that_came_apart(const ControlMesh& control) {
  struct Entry {
    std::array<Index, 2> ends;
    Index edge;
  };
  std::vector<Entry> entries;
  for (const Index e : Cancellable(Index(control.edges.size()))) {
    const auto& [a, b] = control.edges[e].vertex;
    if (!control.shared(a) || !control.shared(b)) continue;
    const Index from = control.original_vertex(a), to = control.original_vertex(b);
    entries.push_back({{std::min(from, to), std::max(from, to)}, e});
  }
  std::sort(entries.begin(), entries.end(), [](const Entry& x, const Entry& y) {
    return x.ends != y.ends ? x.ends < y.ends : x.edge < y.edge;
  });
  std::vector<std::array<Index, 2>> apart;
  for (std::size_t i = 1, first = 0; i < entries.size(); ++i) {
    if (entries[i].ends == entries[first].ends)
      apart.push_back({entries[first].edge, entries[i].edge});
    else
      first = i;
  }
  std::sort(apart.begin(), apart.end());
  return apart;
}

// New numbers of edges when copies move behind all others, and which edges are reversed.
struct EdgeMoves {
  std::vector<Index> to;
  std::vector<std::uint8_t> turned;
};

void apply(const EdgeMoves& moves, ControlMesh& control) {
  std::vector<Edge> edges(control.edges.size());
  for (const std::size_t e : Cancellable(edges.size())) {
    Edge edge = control.edges[e];
    if (moves.turned[e]) {
      std::swap(edge.vertex[0], edge.vertex[1]);
      std::swap(edge.side[0], edge.side[1]);
    }
    edges[moves.to[e]] = edge;
  }
  control.edges = std::move(edges);
  for (Side& side : control.sides) {
    side.reversed = side.reversed != bool(moves.turned[side.edge]);
    side.edge = moves.to[side.edge];
  }
  for (Spoke& spoke : control.spokes) {
    spoke.outward = spoke.outward != bool(moves.turned[spoke.edge]);
    spoke.edge = moves.to[spoke.edge];
  }
}

}  // namespace

SheetCopies cut_into_sheets(OwnedPolygonMesh& mesh) {
  const PolygonMesh view = mesh.view();
  const auto vertices = std::size_t(view.vertex_count());
  const HalfEdges half_edges(view);
  SheetCopies copies{{}, {}, begin_double_cover(view, half_edges)};
  DoubleCover& cover = copies.cover;
  const std::vector<Copy> wanted = copies_wanted(half_edges, vertices, cover);
  if (!cover.empty()) cover.over.assign(vertices + wanted.size(), -1);
  std::vector<std::int32_t> fan;
  for (const Copy& copy : wanted) {
    stop_if_cancelled(copies.vertex.size());
    const std::size_t added = vertices + copies.vertex.size();
    copies.vertex.push_back(Index(copy.of));
    copies.second.push_back(copy.second);
    if (copy.second) {
      cover.over[half_edges.from(copy.corner)] = Index(added);
      half_edges.visit_fan(
          copy.corner, [&](std::int32_t corner, bool turned) { cover.turned[corner] = turned; });
      continue;
    }
    fan.clear();
    half_edges.visit_fan(copy.corner, [&](std::int32_t corner, bool) { fan.push_back(corner); });
    for (const std::int32_t corner : fan) mesh.corners[corner] = std::int64_t(added);
  }
  mesh.coordinates.reserve(3 * (vertices + wanted.size()));
  for (const Index v : copies.vertex)
    for (std::size_t a = 0; a < 3; ++a)
      mesh.coordinates.push_back(mesh.coordinates[3 * std::size_t(v) + a]);
  return copies;
}

void find_copied_edges(ControlMesh& control) {
  if (control.copies.vertex.empty()) return;
  const std::vector<std::array<Index, 2>> apart = edges_that_came_apart(control);
  const auto start = [&](Index e) { return control.original_vertex(control.edges[e].vertex[0]); };
  EdgeMoves moves;
  moves.to.assign(control.edges.size(), 0);
  moves.turned.assign(control.edges.size(), 0);
  for (const auto& [original, copy] : apart) {
    moves.to[copy] = -1;
    moves.turned[copy] = start(original) != start(copy);
  }
  Index next = 0;
  for (Index& to : moves.to)
    if (to == 0) to = next++;
  for (const auto& [original, copy] : apart) {
    moves.to[copy] = next++;
    control.copies.edge.push_back(moves.to[original]);
  }
  apply(moves, control);
}

JoinedVertices::JoinedVertices(const ControlMesh& control) {
  if (control.copies.edge.empty()) return;
  UnionFind groups(control.positions.size());
  for (Index e = control.first_copied_edge(); e < Index(control.edges.size()); ++e)
    for (std::size_t h = 0; h < 2; ++h)
      groups.unite(control.edges[e].vertex[h], control.edges[control.original_edge(e)].vertex[h]);
  for (const Index v : Cancellable(control.vertex_count())) {
    first_.push_back(groups.lead(v));
    if (first_.back() != v) others_.emplace_back(first_.back(), v);
  }
  std::sort(others_.begin(), others_.end());
}

SheetNumbers number_sheets(const ControlMesh& control) {
  UnionFind groups(control.positions.size());
  for (const std::size_t e : Cancellable(control.edges.size())) {
    groups.unite(control.edges[e].vertex[0], control.edges[e].vertex[1]);
  }
  SheetNumbers sheets;
  Index next = 0;
  for (const Index v : Cancellable(control.vertex_count())) {
    const Index first = groups.lead(v);
    sheets.of_vertex.push_back(first == v ? next++ : sheets.of_vertex[first]);
    sheets.count += first == v && !control.ring(v).empty();
  }
  return sheets;
}

}  // namespace fairing
