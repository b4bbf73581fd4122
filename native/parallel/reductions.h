// SPDX-License-Identifier: GPL-3.0-or-later
// Parallel loops over long vectors. Sums are taken in blocks of fixed size and added in the order
// of the blocks, so they do not depend on the number of threads. Errors as Workers::for_parts.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include "parallel/workers.h"

namespace fairing {

constexpr std::size_t vector_block = 4096;  // numbers in a block of sums
// Fewer numbers are not worth waking a thread.
constexpr std::size_t vector_grain = 1 << 13;

// Calls body(i) for i in [0, size).
template <class Body>
void for_each_index(Workers& workers, std::size_t size, Body&& body) {
  workers.for_each(size, vector_grain, body);
}

// Σ term(i), in double, block by block.
template <class Term>
double sum(Workers& workers, std::size_t size, Term&& term) {
  const std::size_t blocks = (size + vector_block - 1) / vector_block;
  std::vector<double> partial(blocks);
  workers.for_each(blocks, vector_grain / vector_block, [&](std::size_t b) {
    const std::size_t last = std::min(size, (b + 1) * vector_block);
    // Four running sums let the compiler vectorize without reordering.
    double lane[4] = {0, 0, 0, 0};
    std::size_t i = b * vector_block;
    for (; i + 4 <= last; i += 4)
      for (std::size_t k = 0; k < 4; ++k) lane[k] += term(i + k);
    for (; i < last; ++i) lane[0] += term(i);
    partial[b] = (lane[0] + lane[1]) + (lane[2] + lane[3]);
  });
  double total = 0;
  for (const double p : partial) total += p;
  return total;
}

// The largest |term(i)|; NaN counts as infinite.
template <class Term>
double largest(Workers& workers, std::size_t size, Term&& term) {
  const std::size_t blocks = (size + vector_block - 1) / vector_block;
  std::vector<double> partial(blocks, 0.0);
  workers.for_each(blocks, vector_grain / vector_block, [&](std::size_t b) {
    for (std::size_t i = b * vector_block; i < std::min(size, (b + 1) * vector_block); ++i) {
      const double t = std::abs(double(term(i)));
      partial[b] =
          t <= partial[b] ? partial[b] : (t == t ? t : std::numeric_limits<double>::infinity());
    }
  });
  double most = 0;
  for (const double p : partial) most = std::max(most, p);
  return most;
}

// The Euclidean norm.
template <class T>
double norm(Workers& workers, std::size_t size, const T* x) {
  return std::sqrt(sum(workers, size, [&](std::size_t i) { return double(x[i]) * double(x[i]); }));
}

}  // namespace fairing
