// SPDX-License-Identifier: GPL-3.0-or-later
#include "splines/turns.h"

#include <algorithm>
#include <cmath>

namespace fairing {
namespace {

double angle_between(const Vec3& a, const Vec3& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

// The normal of the cell with corners at p and at its two neighbours in directions d and e.
Vec3 cell_normal(const Lattice& lattice, Index f, GridPoint p, GridPoint d, GridPoint e) {
  const Vec3 at = lattice.position(f, p);
  return (lattice.position(f, {p.i + d.i, p.j + d.j}) - at)
      .cross(lattice.position(f, {p.i + e.i, p.j + e.j}) - at);
}

Vec3 quad_normal(const Lattice& lattice, Index f, int i, int j) {
  return (lattice.position(f, {i + 1, j + 1}) - lattice.position(f, {i, j}))
      .cross(lattice.position(f, {i, j + 1}) - lattice.position(f, {i + 1, j}));
}

double turn_in_quad(const Lattice& lattice, Index f) {
  const int n = lattice.n();
  std::vector<Vec3> below(std::size_t(n), Vec3::Zero());
  double turn = 0;
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) {
      const Vec3 normal = quad_normal(lattice, f, i, j);
      if (i > 0) turn = std::max(turn, angle_between(below[std::size_t(i - 1)], normal));
      if (j > 0) turn = std::max(turn, angle_between(below[std::size_t(i)], normal));
      below[std::size_t(i)] = normal;
    }
  return turn;
}

double turn_in_triangle(const Lattice& lattice, Index f) {
  const int n = lattice.n();
  const auto upward = [&](int i, int j) { return cell_normal(lattice, f, {i, j}, {1, 0}, {0, 1}); };
  double turn = 0;
  for (int j = 0; j < n; ++j)
    for (int i = 0; i + j + 1 < n; ++i) {  // the downward cell, and its three neighbours
      const Vec3 down = cell_normal(lattice, f, {i + 1, j + 1}, {-1, 0}, {0, -1});
      for (const Vec3& up : {upward(i, j), upward(i + 1, j), upward(i, j + 1)})
        turn = std::max(turn, angle_between(down, up));
    }
  return turn;
}

// Of the cell that lies at step k of a side, counted from the edge's first end.
Vec3 beside_edge(const Lattice& lattice, const SideUse& use, int k) {
  const int n = lattice.n(), at = use.reversed ? n - 1 - k : k;
  const auto position = [&](int along, int row) {
    return lattice.position(lattice.point(use.face, use.side, along, row));
  };
  if (lattice.quad(use.face))
    return (position(at + 1, 1) - position(at, 0)).cross(position(at, 1) - position(at + 1, 0));
  return (position(at + 1, 0) - position(at, 0)).cross(position(at, 1) - position(at, 0));
}

}  // namespace

std::vector<double> lattice_turns(const Lattice& lattice, const Topology& topology,
                                  Workers& workers) {
  std::vector<double> turns(std::size_t(lattice.faces()));
  workers.for_parts(turns.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t f = begin; f < end; ++f)
      turns[f] = lattice.quad(Index(f)) ? turn_in_quad(lattice, Index(f))
                                        : turn_in_triangle(lattice, Index(f));
  });
  for (std::size_t e = 0; e < topology.edges.size(); ++e) {
    stop_if_cancelled(e);
    const ControlEdge& edge = topology.edges[e];
    if (edge.kind != EdgeKind::smooth) continue;
    double turn = 0;
    for (int k = 0; k < lattice.n(); ++k)
      turn = std::max(turn, angle_between(beside_edge(lattice, edge.uses[0], k),
                                          beside_edge(lattice, edge.uses[1], k)));
    for (const SideUse& use : edge.uses) {
      double& of_face = turns[std::size_t(use.face)];
      of_face = std::max(of_face, turn);
    }
  }
  return turns;
}

}  // namespace fairing
