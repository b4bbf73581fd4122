// SPDX-License-Identifier: GPL-3.0-or-later
#include "stencil/stencils.h"

#include <cmath>

#include "parallel/cancel.h"

namespace fairing {
namespace {

void fill_vertex(const ControlMesh& mesh, const ChartMaker& charts, Index v, Stencils& s) {
  const auto first = std::size_t(s.ring_offset[std::size_t(v)]);
  const auto last = std::size_t(s.ring_offset[std::size_t(v) + 1]);
  std::fill(s.vertex_rows.begin() + std::ptrdiff_t(5 * first),
            s.vertex_rows.begin() + std::ptrdiff_t(5 * last), 0.f);
  std::fill(s.vertex_half.begin() + std::ptrdiff_t(5 * first),
            s.vertex_half.begin() + std::ptrdiff_t(5 * last), 0.f);
  std::fill(s.vertex_energy.begin() + std::ptrdiff_t(3 * first),
            s.vertex_energy.begin() + std::ptrdiff_t(3 * last), 0.0);
  const bool has_fit = mesh.vertex_fit(v);
  s.vertex_fit[std::size_t(v)] = has_fit;
  if (!has_fit) return;
  const Chart chart = charts.vertex(v);
  const FitRows rows = fit(chart);
  const double root_weight = std::sqrt(chart.area);
  for (std::size_t k = first; k < last; ++k) {
    const auto j = Eigen::Index(k - first);
    const Coefficients half = basis(0.5 * chart.ring[k - first]);
    for (std::size_t c = 0; c < 5; ++c) {
      s.vertex_rows[5 * k + c] = float(rows(Eigen::Index(c), j));
      s.vertex_half[5 * k + c] = float(half(Eigen::Index(c)));
    }
    for (std::size_t c = 0; c < 3; ++c)
      s.vertex_energy[3 * k + c] = root_weight * rows(Eigen::Index(c + 2), j);
  }
}

// Linear at the midpoint to a neighbour; across a quad the mean of its cell's corners: the far one,
// the one next to the point, and the one along the edge.
void fill_linear(const EdgeRingLanes& ring, float* half) {
  for (int j = 0; j < ring.size; ++j) {
    half[8 * j + j] = ring.far[j] ? 0.25f : 0.5f;
    for (int m = 0; ring.far[j] && m < ring.size; ++m)
      if (ring.lane[m] == 0 ? ring.at[m] == ring.at[j]
                            : ring.lane[m] == ring.lane[j] && ring.at[m] == 0)
        half[8 * j + m] = 0.25f;
  }
}

void fill_edge(const ControlMesh& mesh, const ChartMaker& charts, Index e, Stencils& s) {
  const EdgeRingLanes ring(mesh, e);
  float* half = s.edge_half.data() + 64 * std::size_t(e);
  double* energy = s.edge_energy.data() + 24 * std::size_t(e);
  std::fill(half, half + 64, 0.f);
  std::fill(energy, energy + 24, 0.0);
  const bool has_fit = mesh.edge_fit(e);
  s.edge_ring[std::size_t(e)] = std::uint8_t(ring.size);
  s.edge_fit[std::size_t(e)] = has_fit;
  if (!has_fit) return fill_linear(ring, half);
  const Chart chart = charts.edge(e);
  const FitRows rows = fit(chart);
  const double root_weight = std::sqrt(chart.area);
  for (int j = 0; j < ring.size; ++j) {
    const Coefficients at = basis(0.5 * chart.ring[std::size_t(j)]);
    for (int m = 0; m < ring.size; ++m) half[8 * j + m] = float(at.dot(rows.col(m)));
    for (int c = 0; c < 3; ++c) energy[8 * c + j] = root_weight * rows(c + 2, j);
  }
}

void fill_face(const ControlMesh& mesh, const ChartMaker& charts, Index f, Stencils& s) {
  const int directions = mesh.faces[std::size_t(f)].size;
  double* energy = s.face_energy.data() + 12 * std::size_t(f);
  std::fill(energy, energy + 12, 0.0);
  const bool has_fit = mesh.face_part(f) == RegionPart::inside;
  s.face_fit[std::size_t(f)] = has_fit;
  if (!has_fit) return;
  const Chart chart = charts.face(f);
  const FitRows rows = fit(chart);
  const double root_weight = std::sqrt(chart.area);
  // Opposite neighbours have equal weights in the Hessian, so the rows act on second differences.
  for (int c = 0; c < 3; ++c)
    for (int a = 0; a < directions; ++a)
      energy[4 * c + a] = root_weight * 0.5 * (rows(c + 2, a) + rows(c + 2, a + directions));
}

}  // namespace

EnergyRows::EnergyRows(const ControlMesh& mesh, const Stencils& s, Index element) {
  const Index first_edge = mesh.vertex_count(), first_face = first_edge + Index(mesh.edges.size());
  if (element < first_edge) {
    const auto v = std::size_t(element), begin = std::size_t(s.ring_offset[v]);
    if (s.vertex_fit[v]) size_ = std::size_t(s.ring_offset[v + 1]) - begin;
    first_ = s.vertex_energy.data() + 3 * begin;
    step_ = 3, stride_ = 1, period_ = size_;
  } else if (element < first_face) {
    const auto e = std::size_t(element - first_edge);
    if (s.edge_fit[e]) size_ = s.edge_ring[e];
    first_ = s.edge_energy.data() + 24 * e;
    step_ = 1, stride_ = 8, period_ = size_;
  } else {
    const auto f = std::size_t(element - first_face), directions = std::size_t(mesh.faces[f].size);
    if (s.face_fit[f]) size_ = 2 * directions;
    first_ = s.face_energy.data() + 12 * f;
    step_ = 1, stride_ = 4, period_ = directions;
  }
}

MembraneWeights::MembraneWeights(const ControlMesh& mesh, const Stencils& s, Index element) {
  if (!s.membrane.any()) return;
  const Index first_edge = mesh.vertex_count(), first_face = first_edge + Index(mesh.edges.size());
  if (element < first_edge) {
    const auto v = std::size_t(element), begin = std::size_t(s.ring_offset[v]);
    size_ = std::size_t(s.ring_offset[v + 1]) - begin;
    first_ = s.membrane.vertex.data() + begin;
    period_ = std::max<std::size_t>(size_, 1);
  } else if (element < first_face) {
    const auto e = std::size_t(element - first_edge);
    size_ = period_ = s.edge_ring[e];
    first_ = s.membrane.edge.data() + 8 * e;
  } else {
    const auto f = std::size_t(element - first_face);
    period_ = std::size_t(mesh.faces[f].size);
    size_ = 2 * period_;
    first_ = s.membrane.face.data() + 4 * f;
  }
}

Stencils make_stencils(const ControlMesh& mesh, const ChartMaker& charts, Workers& workers,
                       const MembraneOptions& membrane) {
  const auto vertices = std::size_t(mesh.vertex_count()), edges = mesh.edges.size(),
             faces = mesh.faces.size();
  Stencils s;
  s.ring_offset.resize(vertices + 1);
  s.ring_offset[0] = 0;
  for (std::size_t v = 0; v < vertices; ++v) {
    stop_if_cancelled(v);
    s.ring_offset[v + 1] = s.ring_offset[v] + ring_size(mesh, Index(v));
  }
  const auto neighbours = std::size_t(s.ring_offset.back());
  s.vertex_fit.resize(vertices);
  s.vertex_rows.resize(5 * neighbours);
  s.vertex_half.resize(5 * neighbours);
  s.vertex_energy.resize(3 * neighbours);
  s.edge_ring.resize(edges);
  s.edge_fit.resize(edges);
  s.edge_half.resize(64 * edges);
  s.edge_energy.resize(24 * edges);
  s.face_fit.resize(faces);
  s.face_energy.resize(12 * faces);
  workers.for_parts(vertices, 64, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) fill_vertex(mesh, charts, Index(v), s);
  });
  workers.for_parts(edges, 64, [&](std::size_t begin, std::size_t end) {
    for (std::size_t e = begin; e < end; ++e) fill_edge(mesh, charts, Index(e), s);
  });
  workers.for_parts(faces, 64, [&](std::size_t begin, std::size_t end) {
    for (std::size_t f = begin; f < end; ++f) fill_face(mesh, charts, Index(f), s);
  });
  s.membrane = make_membrane(mesh, charts, s.ring_offset, membrane);
  return s;
}

}  // namespace fairing
