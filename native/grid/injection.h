// SPDX-License-Identifier: GPL-3.0-or-later
// Injection: the values of a fine level at the points of the coarse level.
#pragma once

#include "grid/runs.h"

namespace fairing {

// x_coarse <- x_fine at the points of both levels; `fine` is one level above `coarse`. C numbers a
// point.
template <int C, class T>
void inject(const GridLevel& coarse, const GridLevel& fine, Workers& workers, const T* x_fine,
            T* x_coarse) {
  // The points of a run are every second one of the fine level's run, from its second point on.
  const auto first_of = [&](const Run& run) {
    if (run.kind == RunKind::edge) return std::size_t(fine.edge_base(run.element)) + 1;
    return std::size_t(fine.face_base(run.element)) +
           interior_row(run.quad, std::size_t(fine.n()), std::size_t(2 * run.row)) + 1;
  };
  for_each_run(coarse, workers, [&](const Run& run) {
    T* const to = x_coarse + C * run.first;
    if (run.kind == RunKind::vertex) return copy_point<C>(to, x_fine + C * run.first);
    const T* const from = x_fine + C * first_of(run);
    for (std::size_t i = 0; i < run.count; ++i) copy_point<C>(to + C * i, from + 2 * C * i);
  });
}

}  // namespace fairing
