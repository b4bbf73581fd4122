// SPDX-License-Identifier: GPL-3.0-or-later
// The divided differences of a whole control mesh: one set of rows for each control vertex, control
// edge and control face. They serve every level: level l multiplies the energy's rows by 2^l.
//
// An *element* is a control vertex v, a control edge e or a control face f, numbered v, V + e, V +
// E + f. All points of an element have the same stencil.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "grid/runs.h"
#include "parallel/memory.h"
#include "parallel/workers.h"
#include "stencil/chart.h"
#include "stencil/fit.h"
#include "stencil/membrane.h"

namespace fairing {

// Numbers of each element's neighbours, in the order of its chart (stencil/chart.h). There are no
// divided differences on curves, at corners and outside a region: all of their numbers are zero.
struct Stencils {
  using Column = std::array<double, 3>;

  std::vector<std::size_t> begin;     // of each element's neighbours, and one more
  std::vector<std::uint8_t> has_fit;  // one an element: whether there are divided differences
  // The last three rows of the fit (the Hessian) times the root of the chart's area. Opposite
  // neighbours of a point inside a face have the same.
  Array<Column> energy;
  // Weights of the membrane (stencil/membrane.h). Empty, not zeros, without one: levels differ.
  Array<double> tension;
  // 5 a neighbour, of vertices and edges only: the fit, and the basis half-way to the neighbour.
  Array<float> rows, half;

  // None without divided differences.
  std::span<const Column> columns(Index element) const {
    const auto e = std::size_t(element);
    return {energy.data() + begin[e], has_fit[e] ? begin[e + 1] - begin[e] : 0};
  }
  // None without tension.
  std::span<const double> weights(Index element) const {
    const auto e = std::size_t(element);
    return {tension.data() + begin[e], tension.empty() ? 0 : begin[e + 1] - begin[e]};
  }
  double total_weight(Index element) const {
    double sum = 0;
    for (const double weight : weights(element)) sum += weight;
    return sum;
  }
};

// The element of a run.
inline Index element_of(const ControlMesh& mesh, const Run& run) {
  if (run.kind == RunKind::vertex) return run.element;
  const Index first_edge = mesh.vertex_count();
  return run.element + first_edge + (run.kind == RunKind::edge ? 0 : Index(mesh.edges.size()));
}

// Makes all of them. Throws FairingError(cancelled).
Stencils make_stencils(const ControlMesh& mesh, const ChartMaker& charts, Workers& workers,
                       const MembraneOptions& membrane = {});

}  // namespace fairing
