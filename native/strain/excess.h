// SPDX-License-Identifier: GPL-3.0-or-later
// The strain of each vertex alone: a vertex with an error also strains its neighbours, by up to
// half of it and in the opposite direction.
#pragma once

#include <vector>

#include "strain/ease_system.h"

namespace fairing {

struct StrainSystem {
  const LoadMatrix& matrix;  // square
  const Columns& normals;    // one a row: direction of its error; zero: any direction
  const std::vector<std::vector<Index>>& images;  // of each row: the row and its mirror images
};

// Length of a way along the row's normal, or its full length without a normal.
double way_length(const Eigen::RowVector3d& way, const Eigen::RowVector3d& normal);

// The ways -g_j / G_jj of these loads, as rows are released one after another with their images:
// each time the row with the longest way, until none exceeds its number in `floors`. Also the
// remaining ways of the other rows.
Columns ways_one_by_one(const StrainSystem& of, const Columns& loads,
                        const std::vector<double>& floors);

}  // namespace fairing
