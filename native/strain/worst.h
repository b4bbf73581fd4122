// SPDX-License-Identifier: GPL-3.0-or-later
// The few unknowns of strain/ease.h that strain most, one after the other, let go of.
#pragma once

#include "strain/ease.h"

namespace fairing {

struct Candidates {
  const std::vector<std::uint8_t>& may;  // one a row: over zero where it may move
  // Of each row: it and its mirror images, which move with it and are not counted.
  const std::vector<std::vector<Index>>& images;
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
