// SPDX-License-Identifier: GPL-3.0-or-later
// The unknowns of one level, point by point, in the order of the grid's numbering.
#pragma once

#include <cstdint>
#include <vector>

#include "grid/accumulate.h"

namespace fairing {

// How many points are unknowns.
std::size_t count_unknowns(const GridLevel& grid, const Unknowns& unknowns);

// Per point: whether it is an unknown. Throws FairingError(cancelled).
std::vector<std::uint8_t> unknown_points(const GridLevel& grid, const Unknowns& unknowns);

// Per point: the unknowns numbered 0, 1, … in the order of the points; -1 for the others. Rows and
// columns of assembled systems have these numbers.
std::vector<Index> number_unknowns(const GridLevel& grid, const Unknowns& unknowns);

}  // namespace fairing
