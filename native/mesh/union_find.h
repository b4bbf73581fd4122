// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cstddef>
#include <numeric>

#include "base/types.h"
#include "parallel/memory.h"

namespace fairing {

// Disjoint sets of the numbers 0 … count - 1, each represented by its least member.
class UnionFind {
 public:
  explicit UnionFind(std::size_t count) : lead_(count) {
    std::iota(lead_.begin(), lead_.end(), Index(0));
  }

  Index lead(Index i) {
    for (;;) {
      Index& above = lead_[i];
      if (above == i) return i;
      i = above = lead_[above];  // path halving
    }
  }
  // Returns whether they were two sets.
  bool unite(Index i, Index j) {
    const Index a = lead(i), b = lead(j);
    lead_[std::max(a, b)] = std::min(a, b);
    return a != b;
  }

 private:
  Array<Index> lead_;
};

}  // namespace fairing
