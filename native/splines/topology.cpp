// SPDX-License-Identifier: GPL-3.0-or-later
#include "splines/topology.h"

#include <algorithm>
#include <set>
#include <unordered_map>

#include "mesh/union_find.h"
#include "mesh/vertex_pair.h"
#include "parallel/cancel.h"

namespace fairing {
namespace {

// The middle point of a side belongs to its control edge only, whatever its ends are.
void find_edges(const Lattice& lattice, Topology& out) {
  const int n = lattice.n();
  std::unordered_map<Index, Index> edge_of;
  out.face_edges.resize(std::size_t(lattice.faces()));
  for (const Index f : Cancellable(lattice.faces())) {
    for (int s = 0; s < lattice.corners(f); ++s) {
      const Index middle = lattice.point(f, s, n / 2, 0);
      const auto [found, is_new] = edge_of.try_emplace(middle, Index(out.edges.size()));
      if (is_new) out.edges.emplace_back();
      ControlEdge& edge = out.edges[found->second];
      bool against = false;
      if (!is_new) {
        const SideUse& first = edge.uses.front();
        against = lattice.point(first.face, first.side, 1, 0) != lattice.point(f, s, 1, 0);
      }
      edge.uses.push_back({{f, s}, against});
      edge.halved |= !lattice.quad(f);
      out.face_edges[f][s] = found->second;
    }
  }
}

void find_kinds(const Lattice& lattice, Topology& out) {
  std::set<VertexPair> creases;
  const auto listed = lattice.surface().crease_edges;
  for (std::size_t k = 0; k + 1 < listed.size(); k += 2)
    creases.insert(ascending(listed[k], listed[k + 1]));
  for (ControlEdge& edge : out.edges) {
    if (edge.uses.size() == 1) continue;
    const SideUse& use = edge.uses.front();
    const Index a = lattice.point(use.face, use.side, 0, 0),
                b = lattice.point(use.face, use.side, lattice.n(), 0);
    edge.kind =
        edge.plain() && !creases.contains(ascending(a, b)) ? EdgeKind::smooth : EdgeKind::crease;
  }
}

// Joins the corners at one vertex across smooth edges.
void find_sectors(const Lattice& lattice, Topology& out) {
  const auto corner = [](Index f, int c) { return 4 * f + c; };
  UnionFind groups(4 * std::size_t(lattice.faces()));
  for (const ControlEdge& edge : out.edges) {
    if (edge.kind != EdgeKind::smooth) continue;
    const SideUse &a = edge.uses[0], &b = edge.uses[1];
    const int next_a = (a.side + 1) % lattice.corners(a.face),
              next_b = (b.side + 1) % lattice.corners(b.face);
    groups.unite(corner(a.face, a.side), corner(b.face, next_b));
    groups.unite(corner(a.face, next_a), corner(b.face, b.side));
  }
  out.face_sectors.resize(std::size_t(lattice.faces()));
  std::vector<Index> sector_of(4 * std::size_t(lattice.faces()), -1);
  for (const Index f : Cancellable(lattice.faces())) {
    for (int c = 0; c < lattice.corners(f); ++c) {
      Index& sector = sector_of[groups.lead(corner(f, c))];
      if (sector < 0) {
        sector = Index(out.sectors.size());
        out.sectors.emplace_back();
      }
      out.sectors[sector].push_back({int(f), c});
      out.face_sectors[f][c] = sector;
    }
  }
  for (ControlEdge& edge : out.edges) {
    const SideUse& use = edge.uses.front();
    const auto& around = out.face_sectors[use.face];
    const int next = (use.side + 1) % lattice.corners(use.face);
    edge.sectors = {around[use.side], around[next]};
  }
}

}  // namespace

HalfEdge Topology::twin(HalfEdge h) const {
  const ControlEdge& own = edge(h);
  if (own.uses.size() != 2) return {};
  return own.uses[own.uses[0] == h ? 1 : 0];
}

bool Topology::runs_back(HalfEdge h) const {
  for (const SideUse& use : edge(h).uses)
    if (use == h) return use.reversed;
  return false;
}

int EdgeChain::least_spans() const {
  const int all = int(edges.size()), inside = int(cuts.size()) - 2;
  return 2 * inside > all ? 2 * all : all;
}

int most_spans_on(const Lattice& lattice, int faces, bool third, bool several, int steps) {
  int each = std::clamp(lattice.n() / (third ? 2 * steps : steps), 1,
                        several ? most_spans / steps_a_span : most_spans);
  while (each > 1 && faces * each > steps_a_span * most_spans) each /= 2;
  return faces * each;
}

bool in_tip(const Lattice& lattice, const Topology& topology, Index f, GridPoint p) {
  const int n = lattice.n(), far = n - p.i - p.j;
  const std::array<int, 4> in_quad{std::max(p.i, p.j), std::max(n - p.i, p.j),
                                   std::max(n - p.i, n - p.j), std::max(p.i, n - p.j)};
  const std::array<int, 4> in_triangle{n - far, n - p.i, n - p.j, n};
  const std::array<int, 4>& steps = lattice.quad(f) ? in_quad : in_triangle;
  for (int c = 0; c < lattice.corners(f); ++c) {
    const Index sector = topology.face_sectors[f][c];
    if (steps[c] < steps_a_span && topology.kinks[sector] == Kink::sharp) return true;
  }
  return false;
}

Topology make_topology(const Lattice& lattice) {
  Topology out;
  find_edges(lattice, out);
  find_kinds(lattice, out);
  find_sectors(lattice, out);
  return out;
}

}  // namespace fairing
