// SPDX-License-Identifier: GPL-3.0-or-later
#include "splines/layout.h"

#include <algorithm>
#include <unordered_map>
#include <unordered_set>

#include "base/angle.h"
#include "parallel/cancel.h"

namespace fairing {
namespace {

HalfEdge next(HalfEdge h) { return {h.face, (h.side + 1) % 4}; }
HalfEdge before(HalfEdge h) { return {h.face, (h.side + 3) % 4}; }

class WallFinder {
 public:
  WallFinder(const Lattice& lattice, const Topology& topology, std::span<const std::int32_t> groups,
             double straight)
      : lattice_(lattice), topology_(topology), groups_(groups), straight_(straight) {}

  Walls run() {
    number_vertices();
    out_.edge.assign(topology_.edges.size(), 0);
    for (std::size_t e = 0; e < topology_.edges.size(); ++e) find_wall(e);
    for (Index f = 0; f < lattice_.faces(); ++f)
      for (int c = 0; c < lattice_.corners(f); ++c) add_corner(f, c);
    out_.regular.assign(around_.size(), 0);
    for (std::size_t v = 0; v < around_.size(); ++v) out_.regular[v] = is_regular(around_[v]);
    return std::move(out_);
  }

 private:
  struct WallEnd {
    EdgeKind kind;
    Vec3 away;
  };
  struct Around {
    int corners = 0;
    bool odd = false;  // triangles, faces with other orientations, or a corner between walls
    std::vector<WallEnd> walls;
  };

  void number_vertices() {
    std::unordered_map<Index, Index> number;
    out_.vertices.resize(std::size_t(lattice_.faces()));
    for (Index f = 0; f < lattice_.faces(); ++f)
      for (int c = 0; c < lattice_.corners(f); ++c)
        out_.vertices[f][c] =
            number.try_emplace(lattice_.point(f, c, 0, 0), Index(number.size())).first->second;
    around_.resize(number.size());
  }

  void find_wall(std::size_t e) {
    const ControlEdge& edge = topology_.edges[e];
    const auto group = [&](const SideUse& use) { return groups_[use.face]; };
    if (edge.kind == EdgeKind::smooth &&
        (groups_.empty() || group(edge.uses[0]) == group(edge.uses[1])) && !is_stop(edge))
      return;
    out_.edge[e] = 1;
    const SideUse& use = edge.uses.front();
    for (const bool at_end : {false, true}) {
      const int c = (use.side + at_end) % lattice_.corners(use.face);
      Around& around = around_[out_.vertices[use.face][c]];
      around.walls.push_back({edge.kind, end_tangent(lattice_, use.face, use.side, at_end)});
      around.odd |= edge.kind == EdgeKind::crease && !edge.plain();
    }
  }

  // Whether a smooth curve across the edge, with a knot at it, would turn back beside it. With even
  // knots its speed there is half the sum of the lengths a and b of both sides; a cubic from end to
  // end of the shorter one turns back above three times that one's length (Fritsch and Carlson 1980).
  bool is_stop(const ControlEdge& edge) const {
    const HalfEdge h = edge.uses[0], g = edge.uses[1];
    if (!edge.plain() || !lattice_.quad(h.face) || !lattice_.quad(g.face)) return false;
    return turns_back(before(h), next(g)) || turns_back(before(g), next(h));
  }
  bool turns_back(HalfEdge to, HalfEdge from) const {
    const double a = length_of(to), b = length_of(from);
    if (a + b <= 6 * std::min(a, b)) return false;
    // where the surface is straight, a curve may have its length as parameter
    return angle_between(normal_at(to, 0), normal_at(to, lattice_.n())) > straight_ ||
           angle_between(normal_at(from, 0), normal_at(from, lattice_.n())) > straight_;
  }
  Vec3 normal_at(HalfEdge h, int k) const {
    return lattice_normal(lattice_, h.face, closed_point(true, lattice_.n(), h.side, k, 0));
  }
  double length_of(HalfEdge h) const {
    double out = 0;
    for (int k = 0; k < lattice_.n(); ++k)
      out += (lattice_.position(lattice_.point(h.face, h.side, k + 1, 0)) -
              lattice_.position(lattice_.point(h.face, h.side, k, 0)))
                 .norm();
    return out;
  }

  void add_corner(Index f, int c) {
    Around& around = around_[out_.vertices[f][c]];
    ++around.corners;
    const auto wall = [&](int s) { return out_.edge[topology_.face_edges[f][s]]; };
    const int last = lattice_.corners(f) - 1;
    around.odd |= !lattice_.quad(f) || (wall(c) && wall((c + last) % (last + 1)));
  }

  bool is_regular(const Around& around) const {
    if (around.odd || (around.walls.size() != 2 && !around.walls.empty())) return false;
    if (around.walls.empty()) return around.corners == 4;
    const auto& [a, b] = std::tie(around.walls[0], around.walls[1]);
    return a.kind == b.kind && around.corners == (a.kind == EdgeKind::boundary ? 2 : 4) &&
           (a.kind == EdgeKind::smooth || angle_between(a.away, -b.away) <= straight_);
  }

  const Lattice& lattice_;
  const Topology& topology_;
  std::span<const std::int32_t> groups_;
  double straight_;
  std::vector<Around> around_;
  Walls out_;
};

class Layout {
 public:
  Layout(const Lattice& lattice, const Topology& topology, const Walls& walls)
      : lattice_(lattice),
        topology_(topology),
        walls_(walls),
        drawn_(walls.edge),
        grid_of_(std::size_t(lattice.faces()), -1) {}

  std::vector<FaceGrid> run() {
    draw_lines();
    for (Index f = lattice_.triangle_faces(); f < lattice_.faces(); ++f) {
      stop_if_cancelled(std::size_t(f));
      if (grid_of_[f] < 0) grow({1, 1, {{f, 0}}});
    }
    while (merge_some()) {
    }
    std::erase_if(grids_, [](const FaceGrid& grid) { return grid.faces.empty(); });
    return std::move(grids_);
  }

 private:
  std::size_t edge(HalfEdge h) const { return std::size_t(topology_.face_edges[h.face][h.side]); }
  bool regular(HalfEdge h) const { return walls_.regular[walls_.start(h)]; }

  // All lines advance by one edge, then by the next, so they meet half-way.
  void draw_lines() {
    std::vector<std::uint8_t> met(walls_.regular.size(), 0);
    std::vector<HalfEdge> ends;
    for (Index f = 0; f < lattice_.faces(); ++f)
      for (int s = 0; s < lattice_.corners(f); ++s) {
        const HalfEdge h{f, s};
        if (walls_.edge[edge(h)] || !lattice_.quad(f)) {
          if (!lattice_.quad(f)) drawn_[edge(h)] = 1;
          if (walls_.edge[edge(h)]) met[walls_.start(h)] = met[end_vertex(h)] = 1;
        } else if (!regular(h)) {
          ends.push_back(h);
        }
      }
    while (!ends.empty()) {
      std::vector<HalfEdge> further;
      for (const HalfEdge h : ends) {
        drawn_[edge(h)] = 1;
        const auto v = std::size_t(end_vertex(h));
        if (met[v] || !walls_.regular[v]) continue;
        met[v] = 1;
        further.push_back(straight_on(topology_, h));
      }
      ends = std::move(further);
    }
  }
  Index end_vertex(HalfEdge h) const {
    return walls_.vertices[h.face][(h.side + 1) % lattice_.corners(h.face)];
  }

  // Adds row after row on all four sides.
  void grow(FaceGrid grid) {
    for (int failed = 0; failed < 4;) {
      std::vector<PlacedFace> row = beyond(grid);
      const bool free = std::all_of(row.begin(), row.end(), [&](const PlacedFace& placed) {
        return grid_of_[placed.face] < 0;
      });
      FaceGrid larger = with_row(grid, row);
      if (!row.empty() && free && !touches_itself(larger)) {
        grid = std::move(larger);
        failed = 0;
      } else {
        grid = turned(grid, 1);
        ++failed;
      }
    }
    for (const PlacedFace& placed : grid.faces) grid_of_[placed.face] = Index(grids_.size());
    grids_.push_back(std::move(grid));
  }

  static FaceGrid with_row(FaceGrid grid, const std::vector<PlacedFace>& row) {
    grid.faces.insert(grid.faces.end(), row.begin(), row.end());
    ++grid.rows;
    return grid;
  }

  // The faces above a grid, if no line is between; otherwise none.
  std::vector<PlacedFace> beyond(const FaceGrid& grid) const {
    std::vector<PlacedFace> row;
    for (int q = grid.columns - 1; q >= 0; --q) {
      const HalfEdge own = half_edge(grid, 2, q);
      if (drawn_[edge(own)]) return {};
      const HalfEdge other = topology_.twin(own);
      if (!row.empty()) {
        const PlacedFace& left = row.back();
        const HalfEdge shared{left.face, (left.turn + 1) % 4};
        const HalfEdge across = topology_.twin(shared);
        if (drawn_[edge(shared)] || across != before(other) || other.face == row.front().face)
          return {};
      }
      row.push_back({other.face, other.side});
    }
    if (std::any_of(row.begin(), row.end(), [&](const PlacedFace& placed) {
          return std::any_of(grid.faces.begin(), grid.faces.end(),
                             [&](const PlacedFace& own) { return own.face == placed.face; });
        }))
      return {};
    return row;
  }

  // Around a ring it would meet itself.
  bool touches_itself(const FaceGrid& grid) const {
    std::unordered_set<Index> seen;
    for (int s = 0; s < 4; ++s)
      for (int q = 0; q < length(grid, s); ++q)
        if (!seen.insert(walls_.start(half_edge(grid, s, q))).second) return true;
    return false;
  }

  bool merge_some() {
    bool merged = false;
    for (const std::size_t a : Cancellable(grids_.size())) {
      for (int s = 0; s < 4 && !grids_[a].faces.empty(); ++s) merged |= merge(a, s);
    }
    return merged;
  }

  bool merge(std::size_t a, int side) {
    FaceGrid grid = turned(grids_[a], (side + 2) % 4);  // `side` is at the top
    if (!may_cross(grid)) return false;
    const HalfEdge first = topology_.twin(half_edge(grid, 2, grid.columns - 1));
    const Index b = grid_of_[first.face];
    if (b < 0 || std::size_t(b) == a) return false;
    for (int s = 0; s < 4; ++s) {
      const FaceGrid other = turned(grids_[b], s);
      if (other.columns != grid.columns || !lies_on(grid, other)) continue;
      grid.faces.insert(grid.faces.end(), other.faces.begin(), other.faces.end());
      grid.rows += other.rows;
      if (touches_itself(grid)) return false;
      for (const PlacedFace& placed : other.faces) grid_of_[placed.face] = Index(a);
      grids_[b] = {};
      grids_[a] = std::move(grid);
      return true;
    }
    return false;
  }

  // Whether there is no wall above a grid, and no line that is required there.
  bool may_cross(const FaceGrid& grid) const {
    for (int q = 0; q < grid.columns; ++q) {
      const HalfEdge own = half_edge(grid, 2, q);
      if (walls_.edge[edge(own)] || !regular(own) || !regular(next(own))) return false;
    }
    return true;
  }

  bool lies_on(const FaceGrid& grid, const FaceGrid& other) const {
    for (int q = 0; q < grid.columns; ++q)
      if (topology_.twin(half_edge(grid, 2, grid.columns - 1 - q)) != half_edge(other, 0, q))
        return false;
    return true;
  }

  const Lattice& lattice_;
  const Topology& topology_;
  const Walls& walls_;
  std::vector<std::uint8_t> drawn_;  // by edge
  std::vector<Index> grid_of_;       // by face
  std::vector<FaceGrid> grids_;
};

}  // namespace

namespace {

// The face at (i, j) of the grid with side s as the first one.
PlacedFace face_in_turned(const FaceGrid& grid, int s, int i, int j) {
  const int right = grid.columns - 1, top = grid.rows - 1;
  const int column[4] = {i, right - j, right - i, j}, row[4] = {j, i, top - j, top - i};
  const PlacedFace& placed = grid.faces[row[s] * grid.columns + column[s]];
  return {placed.face, (placed.turn + s) % 4};
}

}  // namespace

HalfEdge half_edge(const FaceGrid& grid, int s, int q) {
  const PlacedFace placed = face_in_turned(grid, s, q, 0);
  return {placed.face, placed.turn};
}

FaceGrid turned(const FaceGrid& grid, int s) {
  const int columns = length(grid, s), rows = length(grid, s + 1);
  FaceGrid out{columns, rows, {}};
  out.faces.reserve(grid.faces.size());
  for (int j = 0; j < rows; ++j)
    for (int i = 0; i < columns; ++i) out.faces.push_back(face_in_turned(grid, s, i, j));
  return out;
}

HalfEdge straight_on(const Topology& topology, HalfEdge h) {
  const HalfEdge across = topology.twin(next(h));
  return across.face < 0 ? across : next(across);
}

HalfEdge straight_back(const Topology& topology, HalfEdge h) {
  const HalfEdge across = topology.twin(before(h));
  return across.face < 0 ? across : before(across);
}

Walls find_walls(const Lattice& lattice, const Topology& topology,
                 std::span<const std::int32_t> groups, double straight) {
  return WallFinder(lattice, topology, groups, straight).run();
}

std::vector<FaceGrid> lay_out(const Lattice& lattice, const Topology& topology,
                              const Walls& walls) {
  return Layout(lattice, topology, walls).run();
}

}  // namespace fairing
