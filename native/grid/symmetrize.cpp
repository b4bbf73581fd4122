// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/symmetrize.h"

#include <algorithm>

namespace fairing {
namespace {

GridPoint corner(bool quad, int n, int c) {
  switch (c) {
    case 0: return {0, 0};
    case 1: return {n, 0};
    case 2: return quad ? GridPoint{n, n} : GridPoint{0, n};
    default: return {0, n};
  }
}

bool lies_in_plane(const ControlMesh& mesh, const Mirror& mirror, const Run& run) {
  switch (run.kind) {
    case RunKind::vertex: return mirror.vertex_in_plane(mesh, run.element);
    case RunKind::edge: return mirror.edge_in_plane(mesh, run.element);
    default: return mirror.turn[run.element] == Mirror::in_plane;
  }
}

// Calls write(p, q) for the unknowns p and their images q, once a pair, at the lower run.
template <class Write>
void for_pairs(const GridLevel& grid, const Mirror& mirror, const Unknowns& unknowns,
               Workers& workers, const Write& write) {
  const ControlMesh& mesh = grid.mesh();
  const int n = grid.n();
  const auto pair = [&](std::size_t p, std::size_t q) {
    if (p <= q) write(p, q);
  };
  for_each_run(grid, workers, [&](const Run& run) {
    const auto element = std::size_t(run.element);
    switch (run.kind) {
      case RunKind::vertex:
        if (unknowns.vertex[element]) pair(run.first, std::size_t(mirror.vertex[element]));
        return;
      case RunKind::edge: {
        const Index image = mirror.edge[element];
        if (image < run.element || !unknowns.edge[element]) return;
        const std::size_t first = std::size_t(grid.edge_base(image)), last = first + run.count - 1;
        const bool reversed = mirror.reverses(mesh, run.element);
        for (std::size_t i = 0; i < run.count; ++i)
          pair(run.first + i, reversed ? last - i : first + i);
        return;
      }
      case RunKind::face_row: {
        const Index image = mirror.face[element];
        if (image < run.element || !unknowns.has_face(element)) return;
        const FaceImage map = face_image(run.quad, n, mirror.turn[element]);
        const std::size_t base = std::size_t(grid.face_base(image));
        for (std::size_t i = 0; i < run.count; ++i) {
          const GridPoint at = map.of(int(i) + 1, run.row);
          pair(run.first + i, base + interior_row(run.quad, std::size_t(n), std::size_t(at.j)) +
                                  std::size_t(at.i - 1));
        }
      }
    }
  });
}

}  // namespace

FaceImage face_image(bool quad, int n, int turn) {
  if (turn == Mirror::in_plane) return {{0, 0}, {1, 0}, {0, 1}};
  const int size = quad ? 4 : 3;
  const auto image = [&](int c) { return corner(quad, n, (turn - c + size) % size); };
  const GridPoint origin = image(0), along = image(1), across = image(size - 1);
  return {origin,
          {(along.i - origin.i) / n, (along.j - origin.j) / n},
          {(across.i - origin.i) / n, (across.j - origin.j) / n}};
}

void symmetrize(const GridLevel& grid, const Symmetry& symmetry, const Unknowns& unknowns,
                Workers& workers, double* x) {
  for (const auto& mirror : symmetry.mirrors)
    for_pairs(grid, *mirror, unknowns, workers, [&](std::size_t p, std::size_t q) {
      Eigen::Map<Vec3> a(x + 3 * p), b(x + 3 * q);
      const Vec3 mean = 0.5 * (a + mirror->plane.image(b));
      b = mirror->plane.image(mean);
      a = mean;
    });
}

void symmetrize_displacements(const GridLevel& grid, const Symmetry& symmetry,
                              const Unknowns& unknowns, Workers& workers, double* h) {
  for (const auto& mirror : symmetry.mirrors) {
    for_pairs(grid, *mirror, unknowns, workers,
              [&](std::size_t p, std::size_t q) { h[p] = h[q] = 0.5 * (h[p] + h[q]); });
    if (grid.mesh().copies.vertex.empty()) continue;
    for_each_run(grid, workers, [&](const Run& run) {
      if (lies_in_plane(grid.mesh(), *mirror, run)) std::fill_n(h + run.first, run.count, 0.0);
    });
  }
}

}  // namespace fairing
