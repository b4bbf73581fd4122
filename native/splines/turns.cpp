// SPDX-License-Identifier: GPL-3.0-or-later
#include "splines/turns.h"

#include "grid/turns.h"

namespace fairing {
namespace {

// The cell at step k of a side, counted from the edge's first end.
CellPlane beside_edge(const Lattice& lattice, const SideUse& use, int k) {
  const int n = lattice.n(), at = use.reversed ? n - 1 - k : k;
  const auto position = [&](int along, int row) {
    return lattice.position(lattice.point(use.face, use.side, along, row));
  };
  if (lattice.quad(use.face))
    return left_cell(position(at, 0), position(at + 1, 0), position(at, 1), position(at + 1, 1));
  return left_cell(position(at, 0), position(at + 1, 0), position(at, 1));
}

}  // namespace

std::vector<double> lattice_turns(const Lattice& lattice, const Topology& topology, double least,
                                  Workers& workers) {
  std::vector<double> turns(std::size_t(lattice.faces()));
  workers.for_each(turns.size(), 1, [&](std::size_t i) {
    const auto f = Index(i);
    const auto tip = [&](GridPoint p) { return in_tip(lattice, topology, f, p); };
    turns[i] = turn_in_face(
        lattice.quad(f), lattice.n(), least, [&](GridPoint p) { return lattice.position(f, p); },
        [&](GridPoint a, GridPoint b) { return !tip(a) && !tip(b); });
  });
  for (const std::size_t e : Cancellable(topology.edges.size())) {
    const ControlEdge& edge = topology.edges[e];
    if (edge.kind != EdgeKind::smooth) continue;
    SharpestTurn turn(least);
    const SideUse& first = edge.uses[0];
    const auto tip = [&](int k) {
      const bool quad = lattice.quad(first.face);
      return in_tip(lattice, topology, first.face,
                    closed_point(quad, lattice.n(), first.side, k, 0));
    };
    for (int k = 0; k < lattice.n(); ++k)
      if (!tip(k) && !tip(k + 1))
        turn.between(beside_edge(lattice, edge.uses[0], k), beside_edge(lattice, edge.uses[1], k));
    for (const SideUse& use : edge.uses) {
      double& of_face = turns[use.face];
      of_face = std::max(of_face, turn.angle());
    }
  }
  return turns;
}

}  // namespace fairing
