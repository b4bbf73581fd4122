// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse/unknown_points.h"

namespace fairing {

std::size_t count_unknowns(const GridLevel& grid, const Unknowns& unknowns) {
  const ControlMesh& mesh = grid.mesh();
  std::size_t count = 0;
  for (std::size_t f = 0; f < mesh.faces.size(); ++f)
    if (unknowns.has_face(f)) count += std::size_t(interior_size(mesh.faces[f].quad(), grid.n()));
  for (const auto u : unknowns.vertex) count += u;
  for (const auto u : unknowns.edge) count += u ? std::size_t(grid.n() - 1) : 0;
  return count;
}

std::vector<std::uint8_t> unknown_points(const GridLevel& grid, const Unknowns& unknowns) {
  std::vector<std::uint8_t> out(grid.size());
  for_each_run(grid, [&](const Run& run) {
    std::fill_n(out.begin() + run.first, run.count, std::uint8_t(unknowns.has(run)));
  });
  return out;
}

std::vector<Index> number_unknowns(const GridLevel& grid, const Unknowns& unknowns) {
  const std::vector<std::uint8_t> unknown = unknown_points(grid, unknowns);
  std::vector<Index> number(unknown.size(), -1);
  Index next = 0;
  for (std::size_t p = 0; p < number.size(); ++p)
    if (unknown[p]) number[p] = next++;
  return number;
}

}  // namespace fairing
