// SPDX-License-Identifier: GPL-3.0-or-later
// The divided differences of a whole control mesh: one set of rows a control vertex, one a control edge, one a control
// face. They serve every level: level l multiplies the energy's rows by 2^l.
#pragma once

#include "chart/chart.h"
#include "control_mesh/control_mesh.h"
#include "difference/fit.h"
#include "execution/memory.h"
#include "execution/workers.h"

namespace fairing {

constexpr int max_edge_ring = 8;  // forward, back, and three points in each of two quads

struct Stencils {
  // Control vertices: the ring of v is ring_offset[v] … ring_offset[v + 1]. Where has_fit is false the rows are zero.
  std::vector<Index> ring_offset;
  std::vector<std::uint8_t> vertex_fit;
  Array<float> vertex_rows;     // 5 a neighbour: the fit
  Array<float> vertex_half;     // 5 a neighbour: the basis half-way to it
  Array<double> vertex_energy;  // 3 a neighbour: sqrt(weight) times the fit's Hessian rows

  // Control edges: rings of edge_ring[e] <= 8 points, padded to 8.
  std::vector<std::uint8_t> edge_ring, edge_fit;
  Array<float> edge_half;     // 8 x 8: value half-way to neighbour j, minus f_0, from the differences
  Array<double> edge_energy;  // 3 x 8

  // Control faces: 3 rows on the second differences along 3 (triangle) or 4 (quad) lattice directions.
  std::vector<std::uint8_t> face_fit;  // false outside a region
  Array<double> face_energy;           // 3 x 4
};

Stencils make_stencils(const ControlMesh& mesh, const ChartOptions& options, Workers& workers);

}  // namespace fairing
