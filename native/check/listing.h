// SPDX-License-Identifier: GPL-3.0-or-later
// How messages begin: the count of elements, the first few ids, and the verb in agreement.
#pragma once

#include <cstdint>
#include <span>
#include <string>

namespace fairing {

struct Words {
  const char *one, *many;
};

constexpr Words face_s{"face", "faces"}, vertex_s{"vertex", "vertices"};

// "1 face (7) has", "12 faces (0, 4, 9, 11, 12, …) have".
std::string listing(Words noun, std::span<const std::int64_t> ids, Words verb);

// Ids laid end to end in pairs: "2 edges (0-4, 4-9) have".
std::string listing_pairs(Words noun, std::span<const std::int64_t> ids, Words verb);

}  // namespace fairing
