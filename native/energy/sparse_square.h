// SPDX-License-Identifier: GPL-3.0-or-later
// R^T R as one sparse matrix in single precision, for levels whose faces have few points: there most points lie on control
// edges and at control vertices, and passes over runs cost several times what an index a number does.
#pragma once

#include <cstdint>
#include <vector>

#include "energy/ring_rows.h"

namespace fairing {

// Of an edge, on levels that it is for.
constexpr int most_points_of_square = 8;

class SparseSquare {
 public:
  // Whether a level is better served so: few points a face, and no rings so large that their squares are not linear.
  static bool suits(const RingRows& rows);

  // The pattern: the unknowns that share a ring.
  SparseSquare(const RingRows& rows, const Unknowns& unknowns);

  // The numbers of rows with that pattern.
  void update(const RingRows& rows, Workers& workers);

  // y <- R^T R x; zero where a point is no unknown.
  void apply(const float* x, Workers& workers, float* y) const;

 private:
  using Place = std::uint16_t;

  // A point's ring by slots, the point first; row c's number for slot s is first[(c * slots + s) * stride].
  struct Ring {
    std::size_t first;
    std::uint32_t begin, stride;  // of its members
  };
  // A ring that a row's point is in, and as what.
  struct Part {
    std::uint32_t ring, slot;
  };
  void find_parts(const std::vector<Index>& unknown);
  void find_columns(const std::vector<Index>& unknown);

  const Lattice& lattice_;
  Array<Ring> ring_;                                            // one a point, and one more
  Array<Index> member_;                                         // of all rings
  Array<float> jacobian_;                                       // three numbers a member
  Array<std::size_t> part_begin_, column_begin_, place_begin_;  // one a point, and one more
  Array<Part> part_;
  Array<Place> place_;  // where in its row each member of each part is added; none: no unknown
  Array<Index> column_;
  Array<float> number_;
};

}  // namespace fairing
