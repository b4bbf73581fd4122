// SPDX-License-Identifier: GPL-3.0-or-later
// The most strained unknowns, and the moves that release them.
#pragma once

#include <span>

#include "strain/ease_system.h"

namespace fairing {

// The rows with the largest of these lengths, `count` of them: one of each that are images of each
// other. Rows whose length is not positive are left out. `images`: of each row, itself and its
// mirror images.
std::vector<Index> worst_rows(const std::vector<double>& lengths, std::size_t count,
                              const std::vector<std::vector<Index>>& images);

// The moves of these rows after which none of them carries a load, a row each. g is square.
Columns moves_without_loads(const LoadMatrix& g, const Columns& loads, std::span<const Index> rows);

}  // namespace fairing
