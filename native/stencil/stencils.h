// SPDX-License-Identifier: GPL-3.0-or-later
// The divided differences of a whole control mesh: one set of rows for each control vertex, control
// edge and control face. They serve every level: level l multiplies the energy's rows by 2^l.
//
// An *element* is a control vertex v, a control edge e or a control face f, numbered v, V + e, V +
// E + f. All points of an element have the same stencil.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "grid/runs.h"
#include "parallel/memory.h"
#include "parallel/workers.h"
#include "stencil/chart.h"
#include "stencil/fit.h"
#include "stencil/membrane.h"

namespace fairing {

// `energy`: the last three rows of the fit (the Hessian) times the root of the chart's area.
// Neighbours are in the order of the charts. Zero without divided differences: on curves, at
// corners and outside a region.
struct Stencils {
  // Control vertices: the ring of v is ring_offset[v] … ring_offset[v + 1].
  std::vector<Index> ring_offset;
  std::vector<std::uint8_t> vertex_fit;  // whether there are divided differences
  Array<float> vertex_rows;              // 5 per neighbour: the fit
  Array<float> vertex_half;              // 5 per neighbour: the basis half-way to it
  Array<double> vertex_energy;           // 3 per neighbour

  // Control edges: rings of edge_ring[e] <= 8 points, padded to 8.
  std::vector<std::uint8_t> edge_ring, edge_fit;
  Array<float> edge_half;  // 8 x 8: value half-way to neighbour j, minus f_0, from the differences
  Array<double> edge_energy;  // 3 x 8

  // Control faces: 3 rows on the second differences along 3 (triangle) or 4 (quad) grid directions
  // (face_directions() in grid/ring.h).
  std::vector<std::uint8_t> face_fit;
  Array<double> face_energy;  // 3 x 4

  Membrane membrane;  // tension
};

// The element of a run.
inline Index element_of(const ControlMesh& mesh, const Run& run) {
  if (run.kind == RunKind::vertex) return run.element;
  const Index first_edge = mesh.vertex_count();
  return run.element + first_edge + (run.kind == RunKind::edge ? 0 : Index(mesh.edges.size()));
}

// The energy's rows of one element by neighbours, in any storage: matrices are assembled from
// these. The centre's numbers are minus the sum of all.
class EnergyRows {
 public:
  using Column = std::array<double, 3>;

  // No neighbours if there are no divided differences. Refers to `stencils`.
  EnergyRows(const ControlMesh& mesh, const Stencils& stencils, Index element);

  std::size_t size() const { return size_; }
  Column operator[](std::size_t neighbour) const {
    const double* at = first_ + step_ * (neighbour % period_);
    return {at[0], at[stride_], at[2 * stride_]};
  }
  // Number of distinct neighbours: all, or half of them inside a face, where opposite ones share
  // their numbers.
  std::size_t distinct() const { return period_; }
  // The k-th neighbour in an order in which opposite neighbours of a face follow one another, so
  // that they are summed in pairs.
  std::size_t by_pairs(std::size_t k) const {
    return period_ < size_ ? k / 2 + period_ * (k % 2) : k;
  }

 private:
  const double* first_;
  std::size_t size_ = 0, step_, stride_, period_;  // opposite neighbours share their numbers
};

// The membrane's weights of one element by neighbours, in the order of its chart; none without
// tension. Refers to `stencils`.
class MembraneWeights {
 public:
  MembraneWeights(const ControlMesh& mesh, const Stencils& stencils, Index element);

  std::size_t size() const { return size_; }
  double operator[](std::size_t neighbour) const { return first_[neighbour % period_]; }
  double total() const {
    double sum = 0;
    for (std::size_t k = 0; k < size_; ++k) sum += (*this)[k];
    return sum;
  }

 private:
  const double* first_ = nullptr;
  std::size_t size_ = 0, period_ = 1;  // opposite neighbours share their weights
};

// Makes all of them. Throws FairingError(cancelled).
Stencils make_stencils(const ControlMesh& mesh, const ChartMaker& charts, Workers& workers,
                       const MembraneOptions& membrane = {});

}  // namespace fairing
