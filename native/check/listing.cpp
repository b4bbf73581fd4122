// SPDX-License-Identifier: GPL-3.0-or-later
#include "check/listing.h"

#include <algorithm>

namespace fairing {
namespace {

constexpr std::size_t shown = 5;

template <class Item>
std::string list(Words noun, std::size_t count, Item item, Words verb) {
  std::string text = std::to_string(count) + " " + (count == 1 ? noun.one : noun.many) + " (";
  for (std::size_t i = 0; i < std::min(count, shown); ++i) text += (i ? ", " : "") + item(i);
  return text + (count > shown ? ", …) " : ") ") + (count == 1 ? verb.one : verb.many);
}

}  // namespace

std::string listing(Words noun, std::span<const std::int64_t> ids, Words verb) {
  return list(noun, ids.size(), [&](std::size_t i) { return std::to_string(ids[i]); }, verb);
}

std::string listing_pairs(Words noun, std::span<const std::int64_t> ids, Words verb) {
  const auto pair = [&](std::size_t i) {
    return std::to_string(ids[2 * i]) + "-" + std::to_string(ids[2 * i + 1]);
  };
  return list(noun, ids.size() / 2, pair, verb);
}

}  // namespace fairing
