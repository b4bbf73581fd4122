// SPDX-License-Identifier: GPL-3.0-or-later
#include "energy/total_curvature.h"

#include "energy/surface_walk.h"
#include "lattice/accumulate.h"

namespace fairing {
namespace {

double energy(const RingInSpace& ring, SurfaceChart& chart) {
  const PointCurvature point = point_curvature(ring.view(true), chart);
  return point.area * point.density();
}

}  // namespace

double total_curvature(const Lattice& lattice, Workers& workers, const double* x) {
  const ControlMesh& mesh = lattice.mesh();
  const int n = lattice.n();
  // One number an element, added up in their order: the number of threads leaves no trace.
  std::vector<double> vertex(std::size_t(mesh.vertex_count()), 0.0), edge(mesh.edges.size(), 0.0),
      face(mesh.faces.size(), 0.0);
  // Lifted areas would add up to more than the surface has; the fit's trace, which is not symmetric, does no harm here.
  constexpr const float* lift = nullptr;
  workers.for_parts(vertex.size(), 256, [&](std::size_t begin, std::size_t end) {
    WalkScratch scratch;
    SurfaceChart chart;
    for (std::size_t v = begin; v < end; ++v)
      if (!mesh.feature_vertex[v] && mesh.interior(Index(v)) && mesh.vertex_place(Index(v)) == Place::inside)
        walk_vertex(lattice, Index(v), x, lift, scratch,
                    [&](const RingInSpace& ring, bool) { vertex[v] = energy(ring, chart); });
  });
  workers.for_parts(
      n > 1 ? edge.size() : 0, element_grain(n) * std::size_t(n), [&](std::size_t begin, std::size_t end) {
        WalkScratch scratch;
        SurfaceChart chart;
        for (std::size_t e = begin; e < end; ++e)
          if (!mesh.feature_edge[e] && !mesh.edges[e].boundary() &&
              mesh.edge_place(Index(e)) == Place::inside)
            walk_edge(lattice, Index(e), x, lift, scratch,
                      [&](std::size_t, const RingInSpace& ring, bool) { edge[e] += energy(ring, chart); });
      });
  workers.for_parts(n > 1 ? face.size() : 0, element_grain(n), [&](std::size_t begin, std::size_t end) {
    WalkScratch scratch;
    SurfaceChart chart;
    for (std::size_t f = begin; f < end; ++f)
      if (mesh.face_place(Index(f)) == Place::inside)
        walk_face(lattice, Index(f), x, lift, scratch,
                  [&](int, std::size_t, const RingInSpace& ring, bool) { face[f] += energy(ring, chart); });
  });
  double total = 0;
  for (const auto& part : {vertex, edge, face})
    for (const double e : part) total += e;
  return total;
}

}  // namespace fairing
