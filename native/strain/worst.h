// SPDX-License-Identifier: GPL-3.0-or-later
// The few unknowns of strain/ease.h that strain most, one after the other, let go of.
#pragma once

#include "strain/ease.h"

namespace fairing {

struct Candidates {
  const std::vector<std::uint8_t>& may;  // one a row: over zero where it may move
  const std::vector<Index>& images;      // moves with it, and is not counted; -1: none
  Index most;
};

struct Worst {
  std::vector<Index> rows;             // the most strained first
  std::vector<std::uint8_t> is_image;  // one of each of these
  Columns moves;                       // likewise
};

// Each time the row with the largest |g_j| / G_jj that is left; then all that have been picked let go
// of their loads together: those of the columns picked are zero. g is square.
Worst moves_of_worst(const LoadMatrix& g, const Columns& loads, const Candidates& candidates);

}  // namespace fairing
