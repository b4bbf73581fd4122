// SPDX-License-Identifier: GPL-3.0-or-later
#include "energy/surface_walk.h"

#include <algorithm>

#include "lattice/accumulate.h"

namespace fairing {

Array<float> area_lifts(const Lattice& lattice, Workers& workers, const double* x) {
  const ControlMesh& mesh = lattice.mesh();
  const int n = lattice.n();
  const std::size_t vertices = std::size_t(mesh.vertex_count()), edges = n > 1 ? mesh.edges.size() : 0;
  Array<float> lifts(vertices + edges * std::size_t(n - 1));  // faces come last
  std::vector<std::uint8_t> lifted(edges + 1, 0), lifted_vertex(vertices, 0);
  workers.for_parts(vertices, 256, [&](std::size_t begin, std::size_t end) {
    WalkScratch scratch;
    SurfaceChart chart;
    for (std::size_t v = begin; v < end; ++v) {
      lifts[v] = 0;
      if (!mesh.vertex_fit(Index(v))) continue;
      walk_vertex(lattice, Index(v), x, nullptr, scratch, [&](const RingInSpace& ring, bool closed) {
        lifts[v] = area_lift(ring.view(closed), chart);
        lifted_vertex[v] = lifts[v] > 0;
      });
    }
  });
  workers.for_parts(edges, element_grain(n) * std::size_t(n), [&](std::size_t begin, std::size_t end) {
    WalkScratch scratch;
    SurfaceChart chart;
    for (std::size_t e = begin; e < end; ++e) {
      float* run = lifts.data() + lattice.edge_base(Index(e));
      std::fill_n(run, n - 1, 0.0f);
      if (!mesh.edge_fit(Index(e))) continue;
      walk_edge(lattice, Index(e), x, nullptr, scratch,
                [&](std::size_t i, const RingInSpace& ring, bool closed) {
                  run[i] = area_lift(ring.view(closed), chart);
                  if (run[i] > 0) lifted[e] = 1;
                });
    }
  });
  const auto any = [](const std::vector<std::uint8_t>& marks) {
    return std::find(marks.begin(), marks.end(), 1) != marks.end();
  };
  if (!any(lifted) && !any(lifted_vertex)) return {};
  lifts.resize(lattice.size());
  std::fill(lifts.begin() + std::ptrdiff_t(vertices + edges * std::size_t(n - 1)), lifts.end(), 0.0f);
  return lifts;
}

}  // namespace fairing
