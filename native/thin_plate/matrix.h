// SPDX-License-Identifier: GPL-3.0-or-later
// The thin plate's K on one level as a matrix, in two forms, both from the rows of the stencils
// (stencil/stencils.h) over the same rings (sparse/ring_table.h): in double for a
// factor, in single precision for the smoother. Without a matrix: thin_plate/operator.h.
#pragma once

#include <memory>

#include "multigrid/level_operator.h"
#include "sparse/matrix.h"
#include "sparse/ring_table.h"
#include "thin_plate/operator.h"
#include "thin_plate/surface_rows.h"

namespace fairing {

// K with the control vertices' weights in double, with the differences of a surface if given: for
// the direct solve on the coarsest level, the paper's Gauss-Seidel sweeps, and tests of the passes.
// Throws if the run is cancelled.
AssembledSystem assemble_thin_plate(const GridLevel& grid, const Stencils& stencils,
                                    const Unknowns& unknowns, const VertexWeights& weights,
                                    Workers& workers, const SurfaceRows* surface = nullptr);

// K in single precision for the smoother, on levels whose faces have few points: there, passes over
// faces and edges cost more than an index for each number.
class PlateMatrix {
 public:
  // Null if rings are so large that their squares are not linear, or if the passes are faster, with
  // many points a face. With the differences of a surface if given. Throws if the run is cancelled.
  static std::unique_ptr<PlateMatrix> make(const GridLevel& grid, const Stencils& stencils,
                                           const Unknowns& unknowns, Workers& workers,
                                           const SurfaceRows* surface = nullptr);

  // Sets the weights that are added to the diagonal.
  void set_weights(const VertexWeights& weights);

  // As LevelOperator::write_lines(), with the inverse of the diagonal.
  void write_lines(const Array<float>& inverse_diagonal, LineBand& band, Workers& workers) const;

  // One number a point; 1 if it is not an unknown.
  Array<float> inverse_diagonal(Workers& workers) const;

  // Calls finish(point, count, product) with K x on `count` points, 3 numbers each; x has
  // `vector_room` extra numbers.
  template <class Finish>
  void visit_products(const float* x, Workers& workers, const Finish& finish) const {
    rows_->visit_products(x, workers, [&](std::size_t first, std::size_t count, float* product) {
      for (std::size_t i = 3 * first; i < std::min(3 * (first + count), weight_.size()); ++i)
        product[i - 3 * first] += weight_[i] * x[i];
      finish(first, count, static_cast<const float*>(product));
    });
  }

 private:
  using Rows = std::unique_ptr<const AssembledMatrix>;
  PlateMatrix(const Unknowns& unknowns, std::size_t points, Rows rows)
      : points_(points), rows_(std::move(rows)), moves_(unknowns.vertex) {}

  std::size_t points_;
  Rows rows_;
  std::vector<std::uint8_t> moves_;  // whether a control vertex is an unknown
  std::vector<float> weight_;        // 3 per control vertex or point; empty: none
};

}  // namespace fairing
