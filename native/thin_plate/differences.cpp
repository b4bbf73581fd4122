// SPDX-License-Identifier: GPL-3.0-or-later
#include "thin_plate/differences.h"

#include "parallel/cancel.h"

namespace fairing {

PlateDifferences::PlateDifferences(const GridLevel& grid, const Stencils& stencils,
                                   const Unknowns& unknowns, Workers& workers,
                                   const SurfaceDifferences* surface)
    : mesh_(grid.mesh()),
      stencils_(stencils),
      surface_(surface),
      rings_(grid, unknowns, workers),
      weight_(point_weights(grid)) {
  const double scale = grid.n();
  const auto elements = std::size_t(mesh_.vertex_count()) + mesh_.edges.size() + mesh_.faces.size();
  for (std::size_t element = 0; element < elements; ++element) {
    stop_if_cancelled(element);
    const EnergyRows rows(mesh_, stencils, Index(element));
    const std::size_t begin = column_.size();
    begin_.push_back(rows.size() > 0 ? begin : none);
    if (rows.size() == 0) continue;
    column_.insert(column_.end(), 1 + rows.size(), Column{});
    for (std::size_t k = 0; k < rows.size(); ++k)
      for (std::size_t c = 0; c < 3; ++c) {
        column_[begin + 1 + k][c] = scale * rows[k][c];
        column_[begin][c] -= scale * rows[rows.by_pairs(k)][c];
      }
  }
}

}  // namespace fairing
