// SPDX-License-Identifier: GPL-3.0-or-later
// R^T R, with tension's Laplacian, as one sparse matrix in single precision, for levels whose rows
// are stored (sparse/matrix.h).
//
// Most columns of a row are adjacent, as the points of a run are. So a row is stored in blocks of
// four numbers, zero where there is no entry, with the first of their columns. With eight pieces an
// edge, a row has 18 columns in 7 blocks.
#pragma once

#include <cstdint>
#include <vector>

#include "curvature/ring_jacobian.h"
#include "sparse/matrix.h"

namespace fairing {

class NormalMatrix {
 public:
  // Whether it is faster for a level: rows are stored, there are as many points as a block has
  // columns, and the rings are small enough.
  static bool suits(const RingJacobian& rows);

  // The pattern: unknowns that share a ring. The grid of `rows` must outlive it. Throws cancelled.
  NormalMatrix(const RingJacobian& rows, const Unknowns& unknowns);

  // Computes the numbers for rows with that pattern; `tension`: the weights of AreaTerm.
  void update(const RingJacobian& rows, Workers& workers, const RingJacobian* tension = nullptr);

  // y <- the matrix times x; zero off the unknowns. All numbers of x must be finite.
  void apply(const float* x, Workers& workers, float* y) const;

 private:
  using Place = std::uint16_t;

  // RingJacobian has row c, slot s at data()[first + (c * slots + s) * stride].
  struct Ring {
    std::size_t first;
    std::uint32_t stride;
  };
  // Three rows a point with the same members: those of point p begin at member[begin[p]].
  struct MomentRows {
    Array<std::uint32_t> begin;  // one a point, and one more
    Array<Index> member;
    Array<float> number;  // three a member

    std::size_t size(std::size_t p) const { return begin[p + 1] - begin[p]; }
  };
  // A ring that contains a point, and the point's slot in it.
  struct RingSlot {
    std::uint32_t ring, slot;
  };
  void find_ring_slots(const std::vector<Index>& unknown);
  void find_blocks(const std::vector<Index>& unknown);
  void add_tension(const RingJacobian& weights, Workers& workers);

  const GridLevel& grid_;
  Array<Ring> ring_;     // one a point
  MomentRows jacobian_;  // R; the first member of a ring is the point itself
  // By point, and one more: the begin of its ring slots, blocks and targets.
  Array<std::size_t> ring_slot_begin_, block_begin_, target_begin_;
  Array<RingSlot> ring_slot_;
  // For each ring slot of a point and each member of that ring: the place in the point's row to
  // which their product is added; `none` if the member is not an unknown.
  Array<Place> target_;
  Array<Index> block_;   // the first column of each block
  Array<float> number_;  // four a block
};

}  // namespace fairing
