// SPDX-License-Identifier: GPL-3.0-or-later
#include "constraints/diverged.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "grid/accumulate.h"
#include "parallel/cancel.h"

namespace fairing {
namespace {

using Distances = std::array<double, 4>;  // squared, from each corner

void enlarge(const double* point, const Vec3& from, double& farthest) {
  const double d = (Eigen::Map<const Vec3>(point) - from).squaredNorm();
  farthest = std::max(farthest, std::isfinite(d) ? d : std::numeric_limits<double>::infinity());
}

}  // namespace

std::vector<Index> diverged_stars(const GridLevel& grid, Workers& workers,
                                  std::span<const Vec3> control, const double* x) {
  const ControlMesh& mesh = grid.mesh();
  const int n = grid.n();
  std::vector<Distances> of_face(mesh.faces.size(), Distances{}),
      of_edge(mesh.edges.size(), Distances{});
  workers.for_each(mesh.faces.size(), element_grain(n), [&](std::size_t f) {
    const Face& face = mesh.faces[f];
    const auto first = std::size_t(grid.face_base(Index(f)));
    const std::size_t inside =
        std::size_t(n - 1) * std::size_t(face.quad() ? n - 1 : n - 2) / (face.quad() ? 1 : 2);
    for (const std::size_t i : Cancellable(inside)) {
      for (std::size_t c = 0; c < std::size_t(face.size); ++c)
        enlarge(x + 3 * (first + i), control[face.vertex[c]], of_face[f][c]);
    }
  });
  workers.for_each(mesh.edges.size(), element_grain(n) * std::size_t(n), [&](std::size_t e) {
    for (int k = 1; k < n; ++k)
      for (std::size_t h = 0; h < 2; ++h)
        enlarge(x + 3 * std::size_t(grid.edge_point(Index(e), k)), control[mesh.edges[e].vertex[h]],
                of_edge[e][h]);
  });
  std::vector<Index> out;
  for (Index v = 0; v < mesh.vertex_count(); ++v) {
    const Vec3& centre = control[v];
    double farthest = 0, size = 0;
    for (const Spoke& spoke : mesh.ring(v)) {
      farthest = std::max(farthest, of_edge[spoke.edge][spoke.outward ? 0 : 1]);
      if (spoke.face < 0) continue;
      const Face& face = mesh.faces[spoke.face];
      farthest = std::max(farthest, of_face[spoke.face][spoke.corner]);
      for (std::size_t c = 0; c < std::size_t(face.size); ++c)
        size = std::max(size, (control[face.vertex[c]] - centre).squaredNorm());
    }
    if (farthest > far_away * far_away * size) out.push_back(v);
  }
  return out;
}

}  // namespace fairing
