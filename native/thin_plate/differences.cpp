// SPDX-License-Identifier: GPL-3.0-or-later
#include "thin_plate/differences.h"

#include "multigrid/assembly.h"
#include "parallel/cancel.h"
#include "sparse/unknown_points.h"

namespace fairing {

PlateDifferences::PlateDifferences(const GridLevel& grid, const Stencils& stencils,
                                   const Unknowns& unknowns, Workers& workers,
                                   const SurfaceRows* surface)
    : stencils_(stencils),
      surface_(surface),
      rings_(grid, unknowns, workers),
      weight_(point_weights(grid)) {
  if (surface) {
    visit_rows(surface->rows,
               [&](Index, const RowRun<const float>& run, std::size_t i, const auto&) {
                 for (int s = 0; s < run.slots; ++s)
                   column_.push_back({run.at(0, s, i), run.at(1, s, i), run.at(2, s, i)});
               });
    return;
  }
  const double scale = grid.n();
  column_.reserve(stencils.energy.size() + stencils.has_fit.size());
  for (const std::size_t element : Cancellable(stencils.has_fit.size())) {
    const std::size_t centre = column_.size();
    column_.push_back({});
    for (std::size_t k = stencils.begin[element]; k < stencils.begin[element + 1]; ++k) {
      const Column& energy = stencils.energy[k];
      column_.push_back({scale * energy[0], scale * energy[1], scale * energy[2]});
      for (std::size_t c = 0; c < 3; ++c) column_[centre][c] -= scale * energy[c];
    }
  }
}

void PlateDifferences::add_own(Index p, RowSum& sum) const {
  const RingTable::Ring& ring = rings_.about(p);
  const std::span<const double> tension = stencils_.weights(ring.element);
  for (std::size_t k = 0; k < tension.size(); ++k)
    if (const RingTable::Member q = rings_.members(ring)[k + 1]; q >= 0) sum.add(q, -tension[k]);
  const double extra =
      stencils_.total_weight(ring.element) + (surface_ ? double(surface_->penalty[p]) : 0);
  if (extra != 0) sum.add(p, extra);
}

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
