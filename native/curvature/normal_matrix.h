// SPDX-License-Identifier: GPL-3.0-or-later
// R^T R, with tension's Laplacian, as one sparse matrix in single precision, for levels that have rows
// (sparse/matrix.h).
//
// Of a row's columns most lie beside one another, as the points of a run do. So a row is kept in
// blocks: four numbers, zeros where it has none, and the first of their columns. In eight pieces an
// edge it has 18 columns in 7 blocks.
#pragma once

#include <cstdint>
#include <vector>

#include "curvature/ring_jacobian.h"
#include "sparse/matrix.h"

namespace fairing {

class NormalMatrix {
 public:
  // Whether a level is better served so: it has rows, as many points as a block has columns, and no
  // rings whose squares are too large.
  static bool suits(const RingJacobian& rows);

  // The pattern: the unknowns that share a ring. The grid of `rows` must outlive it. Throws
  // ErrorCode::cancelled.
  NormalMatrix(const RingJacobian& rows, const Unknowns& unknowns);

  // The numbers of rows with that pattern; `tension`: the weights of AreaTerm.
  void update(const RingJacobian& rows, Workers& workers, const RingJacobian* tension = nullptr);

  // y <- the matrix times x; zero where a point is no unknown. All numbers of x have to be finite.
  void apply(const float* x, Workers& workers, float* y) const;

 private:
  using Place = std::uint16_t;

  // In RingJacobian row c's coefficient for slot s is data()[first + (c * slots + s) * stride].
  struct Ring {
    std::size_t first;
    std::uint32_t stride;
  };
  // Three rows a point, over the same members: those of point p begin at member[begin[p]].
  struct MomentRows {
    Array<std::uint32_t> begin;  // one a point, and one more
    Array<Index> member;
    Array<float> number;  // three a member

    std::size_t size(std::size_t p) const { return begin[p + 1] - begin[p]; }
  };
  // A point's part in a ring: it is in this slot.
  struct RingSlot {
    std::uint32_t ring, slot;
  };
  void find_ring_slots(const std::vector<Index>& unknown);
  void find_blocks(const std::vector<Index>& unknown);
  void add_tension(const RingJacobian& weights, Workers& workers);

  const GridLevel& grid_;
  Array<Ring> ring_;     // one a point
  MomentRows jacobian_;  // R: over the rings, a point itself first
  // By point, and one more: where its ring slots, blocks and targets begin.
  Array<std::size_t> ring_slot_begin_, block_begin_, target_begin_;
  Array<RingSlot> ring_slot_;
  // For each ring slot of a point, for each member of that ring: the number, counted within
  // the point's row, to which their product is added; `none` where the member is no unknown.
  Array<Place> target_;
  Array<Index> block_;   // its first column
  Array<float> number_;  // four a block
};

}  // namespace fairing
