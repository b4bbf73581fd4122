// SPDX-License-Identifier: GPL-3.0-or-later
// Numbers without a pattern from numbers with one, and hashes of points.
#pragma once

#include <bit>
#include <cstdint>

namespace fairing {

constexpr std::uint64_t mixed_apart = 0x9e3779b97f4a7c15u;

// Steele's splitmix64; numbers `mixed_apart` from one another give a random sequence.
constexpr std::uint64_t mixed(std::uint64_t number) {
  number += mixed_apart;
  number = (number ^ (number >> 30)) * 0xbf58476d1ce4e5b9u;
  number = (number ^ (number >> 27)) * 0x94d049bb133111ebu;
  return number ^ (number >> 31);
}

// Of three coordinates.
constexpr std::uint64_t hash_of(const double* point) {
  std::uint64_t hash = 0;
  for (int a = 0; a < 3; ++a)
    hash = mixed(hash ^ std::bit_cast<std::uint64_t>(point[a] + 0.0));  // −0 becomes 0
  return hash;
}

}  // namespace fairing
