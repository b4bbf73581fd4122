// SPDX-License-Identifier: GPL-3.0-or-later
// The thin plate's K on one level as a matrix, in two forms, both from the rows of the stencils
// (stencil/stencils.h) over the same rings (sparse/ring_table.h): in double for a
// factor, in single precision for the smoother. Without a matrix: thin_plate/operator.h.
#pragma once

#include <algorithm>
#include <memory>
#include <optional>
#include <vector>

#include "multigrid/level_operator.h"
#include "thin_plate/differences.h"
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
  // Pieces of an edge up to which rows serve. With 8 it takes a tenth less time at level 4 on even
  // faces, but three times the iterations on thin triangles, whose lines are worse without K's
  // numbers. Passes `on_surface` read a row for each point as well.
  static constexpr int most_pieces(bool on_surface) { return on_surface ? 32 : 16; }

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
    workers.for_each(chunk_.size(), 1, [&](std::size_t c) {
      const std::size_t first = c * chunk_rows, count = chunk_[c].end.size();
      alignas(64) float product[3 * chunk_rows + 4];
      multiply(chunk_[c], x, product);
      for (std::size_t i = 3 * first; i < std::min(3 * (first + count), weight_.size()); ++i)
        product[i - 3 * first] += weight_[i] * x[i];
      finish(first, count, static_cast<const float*>(product));
    });
  }

 private:
  // Rows that one thread multiplies; their products stay in a near cache.
  static constexpr std::size_t chunk_rows = 256;
  struct Chunk {
    std::vector<std::uint32_t> end;  // of each row's numbers; a point that is no unknown has none
    std::vector<Index> column;
    std::vector<float> number;
  };

  PlateMatrix(const PlateDifferences& plate, const Unknowns& unknowns, Workers& workers);

  static void multiply(const Chunk& chunk, const float* x, float* product);
  // Calls visit(row, column, number) for all numbers, in parallel; a row is visited by one thread.
  template <class Visit>
  void visit_numbers(Workers& workers, const Visit& visit) const;

  Array<Chunk> chunk_;
  std::optional<CountedBytes> counted_;
  std::vector<std::uint8_t> moves_;  // whether a control vertex is an unknown
  std::vector<float> weight_;        // 3 per control vertex or point; empty: none
};

}  // namespace fairing
