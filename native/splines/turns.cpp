// SPDX-License-Identifier: GPL-3.0-or-later
#include "splines/turns.h"

#include <algorithm>
#include <cmath>

#include "base/angle.h"

namespace fairing {
namespace {

struct Cell {
  Vec3 normal;
  double extent;
};

// A quad by its diagonals.
Cell cell_across(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  return {(c - a).cross(d - b), std::sqrt(std::max((c - a).squaredNorm(), (d - b).squaredNorm()))};
}

Cell triangle_cell(const Vec3& a, const Vec3& b, const Vec3& c) {
  return {
      (b - a).cross(c - a),
      std::sqrt(std::max({(b - a).squaredNorm(), (c - b).squaredNorm(), (a - c).squaredNorm()}))};
}

class Turn {
 public:
  explicit Turn(double least) : least_(least) {}
  // A surface that rounds the edge off passes it at half the height of the smaller cell.
  void between(const Cell& a, const Cell& b) {
    const double angle = angle_between(a.normal, b.normal);
    const double height = std::min(a.extent, b.extent) * std::sin(angle / 2) / 2;
    if (height >= least_) sharpest_ = std::max(sharpest_, angle);
  }
  double sharpest() const { return sharpest_; }

 private:
  double least_, sharpest_ = 0;
};

double turn_in_quad(const Lattice& lattice, const Topology& topology, Index f, double least) {
  const int n = lattice.n();
  const auto tip = [&](int i, int j) { return in_tip(lattice, topology, f, {i, j}); };
  const auto at = [&](int i, int j) { return lattice.position(f, {i, j}); };
  std::vector<Cell> below(std::size_t(n), Cell{Vec3::Zero(), 0});
  Turn turn(least);
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) {
      const Cell cell = cell_across(at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1));
      // the line between two cells
      if (i > 0 && !tip(i, j) && !tip(i, j + 1)) turn.between(below[std::size_t(i - 1)], cell);
      if (j > 0 && !tip(i, j) && !tip(i + 1, j)) turn.between(below[std::size_t(i)], cell);
      below[std::size_t(i)] = cell;
    }
  return turn.sharpest();
}

double turn_in_triangle(const Lattice& lattice, const Topology& topology, Index f, double least) {
  const int n = lattice.n();
  const auto at = [&](int i, int j) { return lattice.position(f, {i, j}); };
  const auto upward = [&](int i, int j) {
    return triangle_cell(at(i, j), at(i + 1, j), at(i, j + 1));
  };
  Turn turn(least);
  for (int j = 0; j < n; ++j)
    for (int i = 0; i + j + 1 < n; ++i) {  // the downward cell with its three neighbours
      if (in_tip(lattice, topology, f, {i, j}) || in_tip(lattice, topology, f, {i + 1, j}) ||
          in_tip(lattice, topology, f, {i, j + 1}))
        continue;
      const Cell down = triangle_cell(at(i + 1, j + 1), at(i, j + 1), at(i + 1, j));
      for (const Cell& up : {upward(i, j), upward(i + 1, j), upward(i, j + 1)})
        turn.between(down, up);
    }
  return turn.sharpest();
}

// The cell at step k of a side, counted from the edge's first end.
Cell beside_edge(const Lattice& lattice, const SideUse& use, int k) {
  const int n = lattice.n(), at = use.reversed ? n - 1 - k : k;
  const auto position = [&](int along, int row) {
    return lattice.position(lattice.point(use.face, use.side, along, row));
  };
  if (lattice.quad(use.face))
    return cell_across(position(at, 0), position(at + 1, 0), position(at + 1, 1), position(at, 1));
  return triangle_cell(position(at, 0), position(at + 1, 0), position(at, 1));
}

}  // namespace

std::vector<double> lattice_turns(const Lattice& lattice, const Topology& topology, double least,
                                  Workers& workers) {
  std::vector<double> turns(std::size_t(lattice.faces()));
  workers.for_parts(turns.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t f = begin; f < end; ++f)
      turns[f] = lattice.quad(Index(f)) ? turn_in_quad(lattice, topology, Index(f), least)
                                        : turn_in_triangle(lattice, topology, Index(f), least);
  });
  for (std::size_t e = 0; e < topology.edges.size(); ++e) {
    stop_if_cancelled(e);
    const ControlEdge& edge = topology.edges[e];
    if (edge.kind != EdgeKind::smooth) continue;
    Turn turn(least);
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
      double& of_face = turns[std::size_t(use.face)];
      of_face = std::max(of_face, turn.sharpest());
    }
  }
  return turns;
}

}  // namespace fairing
