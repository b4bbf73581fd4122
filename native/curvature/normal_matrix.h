// SPDX-License-Identifier: GPL-3.0-or-later
// R^T R, with tension's Laplacian, as one sparse matrix in single precision, for levels whose rows
// are stored.
//
// Most columns of a row are adjacent, as the points of a run are. So a row is stored in blocks of
// four numbers, zero where there is no entry, with the first of their columns. With eight pieces an
// edge, a row has 18 columns in 7 blocks.
#pragma once

#include <cstdint>
#include <vector>

#include "sparse/ring_rows.h"
#include "sparse/ring_table.h"

namespace fairing {

class NormalMatrix {
 public:
  // Pieces of an edge up to which it is faster than passes: twice as fast with few.
  static constexpr int most_pieces = 16;

  // Whether it is faster for a level: rows are stored, there are as many points as a block has
  // columns, and the rings are small enough.
  static bool suits(const RingRows& rows);

  // The pattern: unknowns that share a ring. The grid of `rows` must outlive it. Throws cancelled.
  NormalMatrix(const RingRows& rows, const Unknowns& unknowns, Workers& workers);

  // Computes the numbers for rows with that pattern; `tension`: the weights of AreaTerm.
  void update(const RingRows& rows, Workers& workers, const RingRows* tension = nullptr);

  // y <- the matrix times x; zero off the unknowns. All numbers of x must be finite.
  void apply(const float* x, Workers& workers, float* y) const;

 private:
  using Place = std::uint16_t;

  void find_blocks();
  void add_tension(const RingRows& weights, Workers& workers);

  const GridLevel& grid_;
  const RingTable rings_;
  const RingPlaces places_;
  Array<float> jacobian_;  // R: three numbers a member of a ring
  // By point, and one more: the begin of its blocks and targets.
  Array<std::size_t> block_begin_, target_begin_;
  // For each ring that contains a point and each member of that ring: the place in the point's row
  // to which their product is added; `none` if the member is not an unknown.
  Array<Place> target_;
  Array<Index> block_;   // the first column of each block
  Array<float> number_;  // four a block
};

}  // namespace fairing
