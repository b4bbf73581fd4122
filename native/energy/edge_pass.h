// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>

namespace fairing {

// The two one-ring passes along a control edge, all points at once: for each of `count` numbers (three a point)
//
//   d_j = in[j] - own,  y = rows d (3 rows of 8),  z_j = scale rows_j^T y,  centre -= sum_j z_j.
//
// z has `ring` rows of `count` numbers; ring is from 4 to 8. Nothing may overlap.
void edge_pass(int ring, std::size_t count, const float* const* in, const float* own, const float* rows,
               float scale, float* z, float* centre);
void edge_pass(int ring, std::size_t count, const double* const* in, const double* own, const double* rows,
               double scale, double* z, double* centre);

}  // namespace fairing
