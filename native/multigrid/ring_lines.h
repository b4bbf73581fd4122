// SPDX-License-Identifier: GPL-3.0-or-later
// What an operator K = sum of squares of rows over one-rings tells of lines (line_band.h), run by run.
//
// `Rows` gives the rows of a run: read(run), then slots(), the point itself being slot 0 and its
// neighbours following in the order of RunGather, and product(s, t, i): the scalar product of the
// columns of slots s and t about point i; is_same_along_run(): whether those of all points are.
#pragma once

#include <algorithm>
#include <cmath>

#include "grid/accumulate.h"
#include "multigrid/line_band.h"
#include "sparse/unknown_points.h"

namespace fairing {

// K's number between a point and its neighbour in slot s, were all rings about like its own: where
// the lattice is regular that sums over all pairs of slots that are as far apart. Elsewhere it takes
// the two points' own rings.
template <class Rows>
float coupling(const Rows& rows, const Run& run, int s, std::size_t i) {
  const bool quad = rows.slots() == 1 + int(std::size(quad_ring));
  const bool regular =
      run.kind == RunKind::face_row && (quad || rows.slots() == 1 + int(std::size(triangle_ring)));
  if (!regular) return 2 * std::abs(rows.product(0, s, i));
  const std::span<const GridPoint> ring = face_ring(quad);
  const auto step = [&](int slot) {
    return slot == 0 ? GridPoint{0, 0} : ring[std::size_t(slot) - 1];
  };
  float sum = 0;
  for (int a = 0; a < rows.slots(); ++a)
    for (int b = 0; b < rows.slots(); ++b)
      if (step(a).i - step(b).i == step(s).i && step(a).j - step(b).j == step(s).j)
        sum += rows.product(a, b, i);
  return std::abs(sum);
}

template <class Rows>
void offer_couplings(const GridLevel& grid, const Unknowns& unknowns,
                     const Array<float>& inverse_diagonal, Workers& workers, const Rows& rows,
                     LineBand& band) {
  const std::vector<std::uint8_t> is_unknown = unknown_points(grid, unknowns);
  struct State {
    Rows rows;
    std::vector<Index> points;
    std::vector<float> coupling;  // by slot
  };
  for_each_run(
      grid, workers, [&] { return State{rows, {}, {}}; },
      [&](const Run& run, State& own) {
        if (!unknowns.has(run)) return;
        own.rows.read(run);
        const auto slots = std::size_t(own.rows.slots());
        own.coupling.resize(slots);
        for (std::size_t i = 0; i < run.count; ++i) {
          own.points.assign(1, Index(run.first + i));
          append_ring(grid, run, i, own.points);
          for (std::size_t s = 1; s < slots; ++s) {
            if (i == 0 || !own.rows.is_same_along_run())
              own.coupling[s] = coupling(own.rows, run, int(s), i);
            const auto q = std::size_t(own.points[s]);
            if (is_unknown[q])
              band.offer(own.points[0], Index(q),
                         own.coupling[s] *
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
  };
  ElementSlots<float, 3> slots;
  accumulate_runs(
      grid, workers, slots, nullptr, band.numbers().data(),
      [&] { return State{rows, RunGather<double>(grid, band.places().data())}; },
      [&](const Run& run, float* const* target, State& state) {
        state.rows.read(run);
        const double* const* place = state.place(run);
        const auto is_on_line = [&](int s) {
          return std::any_of(place[s], place[s] + run.count, [](double p) { return p >= 0; });
        };
        bool any = false;
        for (int s = 0; s < state.rows.slots() && !any; ++s) any = is_on_line(s);
        if (!any) return;
        for (int s = 0; s < state.rows.slots(); ++s)
          for (int t = s + 1; t < state.rows.slots(); ++t)
            for (std::size_t i = 0; i < run.count; ++i)
              if (band.are_on_one(place[s][i], place[t][i]))
                band.visit_pair(place[s][i], place[t][i], state.rows.product(s, t, i),
                                [&](bool to_t, int beside, float part) {
                                  target[to_t ? t : s][3 * i + std::size_t(beside)] += part;
                                });
      });
}

// Both, as LevelOperator::write_lines() does it.
template <class Rows>
void write_ring_lines(const GridLevel& grid, const Unknowns& unknowns,
                      const Array<float>& inverse_diagonal, Workers& workers, const Rows& rows,
                      LineBand& band) {
  band.write([&] { offer_couplings(grid, unknowns, inverse_diagonal, workers, rows, band); },
             [&] { add_along_lines(grid, workers, rows, band); });
}

}  // namespace fairing
