// SPDX-License-Identifier: GPL-3.0-or-later
// Rows equal to those of other points. Along an edge and inside a face most points have the same
// stencils around them, so their rows have the same numbers in other columns.
#pragma once

#include <array>
#include <vector>

#include "sparse/matrix.h"
#include "sparse/ring_table.h"

namespace fairing {

// For a stretch of rows that are summed from the rings around a point's own ring, weighted by
// numbers of each ring's element alone.
class RepeatedRows {
 public:
  // `rings` must outlive it.
  explicit RepeatedRows(const RingTable& rings) : rings_(rings) {}

  // Whether the row of the unknown p equals one of the latest; if so, writes it.
  bool write(Index p, RowBuilder& row);

  // Keeps the row of p, which has just been summed, if others may be equal.
  void keep(Index p, const RowBuilder& row);

 private:
  struct Known {
    std::vector<Index> element;       // whose stencils the rings have; empty: no row yet
    std::vector<std::uint8_t> slot;   // of the point in each of these rings
    std::vector<std::uint8_t> place;  // column of each ring's members, or one of the marks
    std::size_t columns = 0;
    RowBuilder::Numbers numbers;
  };
  enum Mark : std::uint8_t { in_no_row = 254, fixed = 255 };

  bool is_again(const Known& known, Index p);

  const RingTable& rings_;
  // A quad has five such rows in turns: deep inside, and along each side.
  std::array<Known, 5> known_;
  std::array<std::uint8_t, 5> latest_{0, 1, 2, 3, 4};  // into known_, most recently used first
  std::vector<Index> column_;
};

}  // namespace fairing
