// SPDX-License-Identifier: GPL-3.0-or-later
#include "thin_plate/membrane.h"

namespace fairing {

// Each point has half of the edges to its neighbours.
double membrane_energy(const GridLevel& grid, const Stencils& stencils, Workers& workers,
                       const double* x) {
  if (!stencils.membrane.any()) return 0;
  ElementSums sums(grid.mesh());
  for_each_run(
      grid, workers, [&] { return RunGather<double, 3>(grid, x); },
      [&](const Run& run, RunGather<double, 3>& gather) {
        const MembraneWeights weight(grid.mesh(), stencils, element_of(grid.mesh(), run));
        const double* const* at = gather(run);
        double sum = 0;
        for (std::size_t i = 0; i < 3 * run.count; ++i)
          for (std::size_t s = 0; s < weight.size(); ++s) {
            const double d = at[0][i] - at[1 + s][i];
            sum += weight[s] * d * d;
          }
        sums.of(run) += 0.5 * sum;
      });
  return sums.total();
}

}  // namespace fairing
