// SPDX-License-Identifier: GPL-3.0-or-later
#include "check/coincidence.h"

#include <bit>

#include "execution/cancel.h"

namespace fairing {
namespace {

std::uint64_t hash(const double* point) {
  std::uint64_t h = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const double value = point[axis] + 0.0;  // −0 and 0 are one point
    h = (h ^ std::bit_cast<std::uint64_t>(value)) * 0x9e3779b97f4a7c15u;
    h ^= h >> 32;
  }
  return h;
}

}  // namespace

std::vector<std::int32_t> first_at_same_point(std::span<const double> coordinates) {
  const std::size_t vertices = coordinates.size() / 3;
  const std::size_t mask = std::bit_ceil(2 * vertices + 1) - 1;
  std::vector<std::int32_t> table(mask + 1, -1), first(vertices);
  for (std::size_t v = 0; v < vertices; ++v) {
    stop_if_cancelled(v);
    const double* p = &coordinates[3 * v];
    for (std::size_t slot = hash(p) & mask;; slot = (slot + 1) & mask) {
      if (table[slot] < 0) table[slot] = std::int32_t(v);
      const double* q = &coordinates[3 * std::size_t(table[slot])];
      if (p[0] != q[0] || p[1] != q[1] || p[2] != q[2]) continue;
      first[v] = table[slot];
      break;
    }
  }
  return first;
}

}  // namespace fairing
