// SPDX-License-Identifier: GPL-3.0-or-later
#include "multigrid/assembly.h"
#include "parallel/cancel.h"
#include "sparse/unknown_points.h"
#include "thin_plate/differences.h"

namespace fairing {
namespace {

// The rows of all points, in order.
void visit_rows(const PlateDifferences& plate, const VisitRows& visit) {
  std::vector<Index> ring_points;
  std::vector<double> numbers;
  for (const std::size_t p : Cancellable(plate.rings().points())) {
    const RingTable::Ring& ring = plate.rings().about(Index(p));
    ring_points.clear();
    numbers.clear();
    const double root = std::sqrt(plate.weight(Index(p)));
    for (std::size_t s = 0; s < ring.size && plate.has_rows(ring); ++s) {
      ring_points.push_back(RingTable::id_of(plate.rings().members(ring)[s]));
      for (const double number : plate.column(ring, s)) numbers.push_back(root * number);
    }
    visit(ring_points, numbers);
  }
}

}  // namespace

AssembledSystem assemble_thin_plate(const GridLevel& grid, const Stencils& stencils,
                                    const Unknowns& unknowns, const VertexWeights& weights,
                                    Workers& workers, const SurfaceRows* surface) {
  const PlateDifferences plate(grid, stencils, unknowns, workers, surface);
  const std::vector<Index> number = number_unknowns(grid, unknowns);
  AssembledSystem system = assemble_square(
      grid, number, nullptr, [&](const VisitRows& visit) { visit_rows(plate, visit); });
  Triplets entries;
  RowSum own(grid.size());
  for (Index i = 0; i < Index(system.unknown_points.size()); ++i) {
    const Index p = system.unknown_points[i];
    plate.add_own(p, own);
    if (std::size_t(p) < weights.size()) own.add(p, weights[p]);
    for (const auto& [q, entry] : own.entries())
      if (entry != 0) entries.emplace_back(i, number[q], entry);
    own.clear();
  }
  if (!entries.empty()) add_entries(entries, system);
  return system;
}

}  // namespace fairing
