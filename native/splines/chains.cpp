// SPDX-License-Identifier: GPL-3.0-or-later
#include "splines/chains.h"

#include <algorithm>

#include "parallel/cancel.h"

namespace fairing {
namespace {

class Chains {
 public:
  Chains(const Lattice& lattice, const Walls& walls, const std::vector<FaceGrid>& grids,
         Topology& topology)
      : lattice_(lattice),
        walls_(walls),
        topology_(topology),
        drawn_(topology.edges.size(), 0),
        lines_at_(walls.regular.size(), 0) {
    for (const FaceGrid& grid : grids)
      for (int s = 0; s < 4; ++s)
        for (int q = 0; q < length(grid, s); ++q) drawn_[edge(half_edge(grid, s, q))] = 1;
    for (Index f = 0; f < lattice.triangle_faces(); ++f)
      for (int s = 0; s < 3; ++s) drawn_[edge({f, s})] = 1;
    for (std::size_t e = 0; e < drawn_.size(); ++e)
      if (drawn_[e])
        for (const int end : {0, 1}) ++lines_at_[vertex(e, end)];
  }

  // Returns a side of the first closed line, starting where another line ends on the far side; no
  // face if there is none.
  HalfEdge run() {
    topology_.chains.clear();
    topology_.places.assign(drawn_.size(), {});
    for (const std::size_t e : Cancellable(drawn_.size())) {
      if (!drawn_[e] || topology_.places[e].chain >= 0) continue;
      HalfEdge h = topology_.edges[e].uses.front();
      for (HalfEdge back = joined(h, false); back.face >= 0; back = joined(h, false)) {
        h = back;
        if (edge(h) == e) return end_at(h);
      }
      follow(h);
    }
    return {};
  }

 private:
  std::size_t edge(HalfEdge h) const { return std::size_t(topology_.face_edges[h.face][h.side]); }
  std::size_t vertex(std::size_t e, int end) const {
    const SideUse& use = topology_.edges[e].uses.front();
    const int c = (use.side + end) % lattice_.corners(use.face);
    return std::size_t(walls_.vertices[use.face][c]);
  }

  // The continuation of a curve beyond a side or before it; no face at its end.
  HalfEdge joined(HalfEdge h, bool forward) const {
    const int c = (h.side + forward) % lattice_.corners(h.face);
    const auto v = std::size_t(walls_.vertices[h.face][c]);
    if (!walls_.regular[v]) return {};
    const HalfEdge on = forward ? straight_on(topology_, h) : straight_back(topology_, h);
    // all lines end where four of them meet, or three at a border
    const bool border = topology_.edge(h).kind == EdgeKind::boundary;
    return on.face >= 0 && drawn_[edge(on)] && lines_at_[v] < (border ? 3 : 4) ? on : HalfEdge{};
  }

  HalfEdge end_at(HalfEdge h) const {
    while (lines_at_[walls_.start(h)] < 3) h = joined(h, true);
    return h;
  }

  void follow(HalfEdge h) {
    EdgeChain chain{topology_.edge(h).kind, {}, {}, {0}};
    for (; h.face >= 0; h = joined(h, true)) {
      const std::size_t e = edge(h);
      topology_.places[e] = {Index(topology_.chains.size()), int(chain.edges.size())};
      chain.edges.push_back(Index(e));
      chain.reversed.push_back(topology_.runs_back(h));
      if (topology_.edges[e].halved) chain.cuts.push_back(chain.halves() - 1);
      const std::size_t v = vertex(e, chain.reversed.back() ? 0 : 1);
      if (joined(h, true).face < 0 || lines_at_[v] > 2) chain.cuts.push_back(chain.halves());
    }
    topology_.chains.push_back(std::move(chain));
  }

  const Lattice& lattice_;
  const Walls& walls_;
  Topology& topology_;
  std::vector<std::uint8_t> drawn_;  // by edge
  std::vector<int> lines_at_;        // by vertex
};

PatchSide side_along(const Topology& topology, HalfEdge first, HalfEdge last) {
  const auto place = [&](HalfEdge h) {
    return topology.places[topology.face_edges[h.face][h.side]];
  };
  const ChainPlace a = place(first), b = place(last);
  const EdgeChain& chain = topology.chains[a.chain];
  const bool against = topology.runs_back(first) != bool(chain.reversed[a.at]);
  return {a.chain, 2 * std::min(a.at, b.at), 2 * std::max(a.at, b.at) + 2, chain.halves(), against};
}

PatchPlace grid_patch(const Topology& topology, FaceGrid grid) {
  PatchPlace out;
  out.grid = std::move(grid);
  for (int s = 0; s < 4; ++s) {
    PatchSide& side = out.side[s];
    side = side_along(topology, half_edge(out.grid, s, 0),
                      half_edge(out.grid, s, length(out.grid, s) - 1));
    side.reversed = side.reversed != (s >= 2);  // the last two sides are opposite to u and v
  }
  return out;
}

// u starts at corner c along side c, v along the side before it.
PatchPlace triangle_patch(const Topology& topology, Index f, int c) {
  const int last = (c + 2) % 3;
  const auto half = [&](int s, bool second) {
    PatchSide side = side_along(topology, {f, s}, {f, s});
    const int middle = side.from + 1;
    (second == side.reversed ? side.to : side.from) = middle;
    return side;
  };
  const auto inner = [&](int s) {
    return PatchSide{Index(topology.chains.size()) + 3 * f + s, 0, 2, 2, false};
  };
  PatchPlace out;
  out.grid.faces.push_back({f, 0});
  out.corner = c;
  out.side = {half(c, false), inner(c), inner(last), half(last, true)};
  out.side[3].reversed = !out.side[3].reversed;
  return out;
}

std::array<FaceGrid, 2> cut_above(FaceGrid grid, int rows) {
  const auto at = grid.faces.begin() + std::ptrdiff_t(rows) * grid.columns;
  FaceGrid above{grid.columns, grid.rows - rows, {}};
  above.faces.assign(at, grid.faces.end());
  grid.faces.erase(at, grid.faces.end());
  grid.rows = rows;
  return {std::move(grid), std::move(above)};
}

// Cuts the grid with the half-edge on a side behind that side's first one.
bool cut_before(HalfEdge h, std::vector<FaceGrid>& grids) {
  for (std::size_t g = 0; g < grids.size(); ++g)
    for (int s = 0; s < 4; ++s)
      for (int q = 1; q < length(grids[g], s); ++q) {
        if (half_edge(grids[g], s, q) != h) continue;
        auto [first, rest] = cut_above(turned(grids[g], (s + 3) % 4), q);  // it is the second side
        grids[g] = std::move(first);
        grids.push_back(std::move(rest));
        return true;
      }
  return false;
}

}  // namespace

std::array<FaceGrid, 2> halves_of(const FaceGrid& grid) {
  FaceGrid upright = turned(grid, grid.columns > grid.rows ? 1 : 0);
  const int rows = upright.rows / 2;
  return cut_above(std::move(upright), rows);
}

void make_patches(const Lattice& lattice, const Walls& walls, std::vector<FaceGrid>& grids,
                  Topology& topology) {
  for (;;) {
    const HalfEdge closed = Chains(lattice, walls, grids, topology).run();
    if (closed.face < 0) break;
    const HalfEdge behind = topology.twin(straight_back(topology, closed));
    if (!cut_before(closed, grids) && !cut_before(behind, grids)) break;
  }
  topology.patches.clear();
  for (Index f = 0; f < lattice.triangle_faces(); ++f)
    for (int c = 0; c < 3; ++c) topology.patches.push_back(triangle_patch(topology, f, c));
  for (const FaceGrid& grid : grids) topology.patches.push_back(grid_patch(topology, grid));
}

}  // namespace fairing
