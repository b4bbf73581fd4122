// SPDX-License-Identifier: GPL-3.0-or-later
// Strain as each vertex' own: a vertex that is out of line strains its neighbours too, by up to a
// half, to the other side.
#pragma once

#include <vector>

#include "strain/ease.h"

namespace fairing {

struct Straining {
  const LoadMatrix& matrix;  // square
  const Columns& normals;    // one a row: along which it is out of line; zero: in any way
  const std::vector<std::vector<Index>>& images;  // of each row: it and its mirror images
};

// The length of a way along a row's normal, and all of it where there is none.
double way_length(const Eigen::RowVector3d& way, const Eigen::RowVector3d& normal);

// Of these loads the ways -g_j / G_jj, as one row after the other is let go, with its images: each time
// the one with the longest way, as long as that is over its own of the `floors`. And the ways that are
// left to the others.
Columns ways_one_by_one(const Straining& of, const Columns& loads,
                        const std::vector<double>& floors);

}  // namespace fairing
