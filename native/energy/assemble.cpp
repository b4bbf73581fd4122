// SPDX-License-Identifier: GPL-3.0-or-later
#include "energy/assemble.h"

#include "execution/cancel.h"
#include "rows/rings.h"

namespace fairing {

std::vector<Index> number_unknowns(const Lattice& lattice, const Unknowns& unknowns) {
  const std::vector<std::uint8_t> unknown = unknown_points(lattice, unknowns);
  std::vector<Index> number(unknown.size(), -1);
  Index next = 0;
  for (std::size_t p = 0; p < number.size(); ++p)
    if (unknown[p]) number[p] = next++;
  return number;
}

AssembledSystem assemble_thin_plate(const Lattice& lattice, const Stencils& stencils,
                                    const Unknowns& unknowns, const VertexWeights& weights) {
  AssembledSystem system;
  const std::vector<Index> number = number_unknowns(lattice, unknowns);
  for (std::size_t p = 0; p < number.size(); ++p)
    if (number[p] >= 0) system.unknown_points.push_back(Index(p));
  std::vector<Eigen::Triplet<double>> entries;
  std::size_t visited = 0;
  visit_stencils(lattice, stencils, [&](const WrittenStencil& s) {
    stop_if_cancelled(visited++);
    for (std::size_t a = 0; a < s.points.size(); ++a) {
      const Index row = number[std::size_t(s.points[a])];
      if (row < 0) continue;
      for (std::size_t b = 0; b < s.points.size(); ++b) {
        const Index column = number[std::size_t(s.points[b])];
        if (column < 0) continue;
        double sum = 0;
        for (std::size_t c = 0; c < 3; ++c) sum += s.column[a][c] * s.column[b][c];
        entries.emplace_back(row, column, sum);
      }
    }
  });
  for (std::size_t v = 0; v < weights.size(); ++v)
    if (number[v] >= 0) entries.emplace_back(number[v], number[v], weights[v]);
  const auto size = Index(system.unknown_points.size());
  system.matrix.resize(size, size);
  stop_if_cancelled();
  system.matrix.setFromTriplets(entries.begin(), entries.end());
  return system;
}

}  // namespace fairing
