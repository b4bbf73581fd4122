// SPDX-License-Identifier: GPL-3.0-or-later
// Unknowns gathered into blocks by how strongly a matrix couples them.
#pragma once

#include <vector>

#include "sparse/matrix.h"

namespace fairing {

// Block b holds the points point[begin[b]] … point[begin[b + 1] - 1]; every point whose row is not
// empty is in one block.
struct StrongBlocks {
  std::vector<Index> point;
  std::vector<std::size_t> begin;
  std::size_t size() const { return begin.size() - 1; }
};

// Each block begins at a point and takes the one that is coupled to it most strongly, over and over,
// up to `most`. So blocks lie along whatever direction is stiff: across thin faces, from one to the
// next. Throws where the run has been cancelled.
StrongBlocks strong_blocks(const SymmetricRows& matrix, std::size_t most);

}  // namespace fairing
