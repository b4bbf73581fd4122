// SPDX-License-Identifier: GPL-3.0-or-later
// Lines (line_band.h) of an operator K = sum of squares of rows over one-rings, run by run.
//
// `Rows` gives the rows of a run: read(run), then slots(), with the point itself as slot 0 and its
// neighbours in the order of RunGather, and product(s, t, i): the scalar product of the columns of
// slots s and t about point i; is_same_along_run(): whether it is the same for all points.
#pragma once

#include <algorithm>
#include <cmath>

#include "grid/accumulate.h"
#include "multigrid/line_band.h"
#include "sparse/unknown_points.h"

namespace fairing {

// K's numbers between the points of a run and their neighbours, as if all neighbours had equal
// rings: on a regular lattice each is the sum over all pairs of slots with the same offset.
// Elsewhere the two points' own rings are used. Slot by slot, one number a point, or one for all.
template <class Rows>
void find_couplings(const Rows& rows, const Run& run, std::vector<float>& coupling) {
  const int slots = rows.slots(), half = slots / 2;
  const std::size_t count = rows.is_same_along_run() ? 1 : run.count;
  coupling.assign(std::size_t(slots) * count, 0.0f);
  const auto add = [&](int slot, int s, int t, float share) {
    float* sum = coupling.data() + std::size_t(slot) * count;
    for (std::size_t i = 0; i < count; ++i) sum[i] += share * rows.product(s, t, i);
  };
  const bool quad = slots == 1 + int(std::size(quad_ring));
  if (run.kind != RunKind::face_row || !(quad || slots == 1 + int(std::size(triangle_ring)))) {
    for (int s = 1; s < slots; ++s) add(s, 0, s, 2);
    return;
  }
  const auto step = [&](int slot) {
    return slot == 0 ? GridPoint{0, 0} : face_ring(quad)[std::size_t(slot) - 1];
  };
  for (int slot = 1; slot <= half; ++slot) {
    for (int s = 0; s < slots; ++s)
      for (int t = 0; t < slots; ++t)
        if (step(s).i - step(t).i == step(slot).i && step(s).j - step(t).j == step(slot).j)
          add(slot, s, t, 1);
    const auto first = coupling.begin() + slot * std::ptrdiff_t(count);
    std::copy_n(first, count, first + half * std::ptrdiff_t(count));  // of the opposite neighbour
  }
}

template <class Rows>
void offer_couplings(const GridLevel& grid, const Unknowns& unknowns,
                     const Array<float>& inverse_diagonal, Workers& workers, const Rows& rows,
                     LineBand& band) {
  const std::vector<std::uint8_t> is_unknown = unknown_points(grid, unknowns);
  struct State {
    Rows rows;
    std::vector<Index> points;
    std::vector<float> coupling;
  };
  for_each_run(
      grid, workers, [&] { return State{rows, {}, {}}; },
      [&](const Run& run, State& own) {
        if (!unknowns.has(run)) return;
        own.rows.read(run);
        find_couplings(own.rows, run, own.coupling);
        for (std::size_t i = 0; i < run.count; ++i) {
          own.points.assign(1, Index(run.first + i));
          append_ring(grid, run, i, own.points);
          const float* coupling = own.coupling.data() + (own.rows.is_same_along_run() ? 0 : i);
          const std::size_t stride = own.rows.is_same_along_run() ? 1 : run.count;
          for (std::size_t s = 1; s < std::size_t(own.rows.slots()); ++s) {
            const auto q = std::size_t(own.points[s]);
            if (is_unknown[q])
              band.offer(own.points[0], Index(q),
                         std::abs(coupling[s * stride]) *
                             std::sqrt(inverse_diagonal[run.first + i] * inverse_diagonal[q]));
          }
        }
      });
}

template <class Rows>
void add_along_lines(const GridLevel& grid, Workers& workers, const Rows& rows, LineBand& band) {
  struct State {
    Rows rows;
    RunGather<double> place;
    std::vector<int> slots;  // those with points on lines
  };
  ElementSlots<float, 3> slots;
  accumulate_runs(
      grid, workers, slots, nullptr, band.numbers().data(),
      [&] { return State{rows, RunGather<double>(grid, band.places().data()), {}}; },
      [&](const Run& run, float* const* target, State& own) {
        own.rows.read(run);
        const double* const* place = own.place(run);
        own.slots.clear();
        for (int s = 0; s < own.rows.slots(); ++s)
          if (std::any_of(place[s], place[s] + run.count, [](double p) { return p >= 0; }))
            own.slots.push_back(s);
        for (std::size_t a = 0; a < own.slots.size(); ++a)
          for (std::size_t b = a + 1; b < own.slots.size(); ++b)
            for (std::size_t i = 0; i < run.count; ++i) {
              const int s = own.slots[a], t = own.slots[b];
              if (band.are_on_one(place[s][i], place[t][i]))
                band.visit_pair(place[s][i], place[t][i], own.rows.product(s, t, i),
                                [&](bool to_t, int beside, float part) {
                                  target[to_t ? t : s][3 * i + std::size_t(beside)] += part;
                                });
            }
      });
}

// Both, as in LevelOperator::write_lines().
template <class Rows>
void write_ring_lines(const GridLevel& grid, const Unknowns& unknowns,
                      const Array<float>& inverse_diagonal, Workers& workers, const Rows& rows,
                      LineBand& band) {
  band.write([&] { offer_couplings(grid, unknowns, inverse_diagonal, workers, rows, band); },
             [&] { add_along_lines(grid, workers, rows, band); });
}

}  // namespace fairing
