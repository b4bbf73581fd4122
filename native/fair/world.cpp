// SPDX-License-Identifier: GPL-3.0-or-later
#include "fair/world.h"

#include "execution/vectors.h"
#include "lattice/linear.h"

namespace fairing {

void to_world(const Placement& place, const Lattice& lattice, const Frame& frame, Workers& workers,
              const double* x, double* world) {
  const ControlMesh& mesh = lattice.mesh();
  const std::vector<Vec3>& given = place.world;
  std::vector<std::uint8_t> kept(given.size());
  for (std::size_t v = 0; v < given.size(); ++v)
    kept[v] = Vec3(x[3 * v], x[3 * v + 1], x[3 * v + 2]) == place.working[v];
  workers.for_parts(lattice.size(), vector_grain / 3, [&](std::size_t begin, std::size_t end) {
    for (std::size_t p = begin; p < end; ++p)
      for (std::size_t a = 0; a < 3; ++a)
        world[3 * p + a] = frame.centre[Eigen::Index(a)] + frame.scale * x[3 * p + a];
  });
  for (std::size_t v = 0; v < given.size(); ++v)
    if (kept[v])
      for (std::size_t a = 0; a < 3; ++a) world[3 * v + a] = given[v][Eigen::Index(a)];
  for (std::size_t e = 0; e < mesh.edges.size(); ++e) {
    if (place.world_curves.run[e] < 0) continue;
    const auto points = place.world_curves.of(Index(e));
    for (std::size_t k = 0; k < points.size(); ++k)
      for (std::size_t a = 0; a < 3; ++a)
        world[3 * (std::size_t(lattice.edge_base(Index(e))) + k) + a] = points[k][Eigen::Index(a)];
  }
  refine_outside_linearly(lattice, given, world);
}

double largest_deviation(const std::vector<Vec3>& given, Index input_vertices, const double* world) {
  double largest = 0;
  for (std::size_t v = 0; v < std::size_t(input_vertices); ++v)
    largest = std::max(largest, (Vec3(world[3 * v], world[3 * v + 1], world[3 * v + 2]) - given[v]).norm());
  return largest;
}

}  // namespace fairing
