// SPDX-License-Identifier: GPL-3.0-or-later
// Releases the few most strained unknowns of strain/ease.h, one after another.
#pragma once

#include "strain/ease.h"

namespace fairing {

struct Candidates {
  const std::vector<std::uint8_t>& may;  // one a row: positive if it may move
  // For each row: the row and its mirror images, which move with it and are not counted.
  const std::vector<std::vector<Index>>& images;
  Index most;
};

struct Worst {
  std::vector<Index> rows;             // the most strained first
  std::vector<std::uint8_t> is_image;  // one of each of these
  Columns moves;                       // likewise
};

// Each time picks the remaining row with the largest |g_j| / G_jj, and then releases all picked
// rows together: the loads of their columns become zero. g is square.
Worst moves_of_worst(const LoadMatrix& g, const Columns& loads, const Candidates& candidates);

}  // namespace fairing
