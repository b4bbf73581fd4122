// SPDX-License-Identifier: GPL-3.0-or-later
#include "check/listing.h"

#include <algorithm>

namespace fairing {
namespace {

constexpr std::size_t shown = 5;

template <class Item>
std::string list(const char* noun, const char* plural, std::size_t count, Item item) {
  std::string text = std::to_string(count) + " " + (count == 1 ? noun : plural) + " (";
  for (std::size_t i = 0; i < std::min(count, shown); ++i) text += (i ? ", " : "") + item(i);
  return text + (count > shown ? ", …)" : ")");
}

}  // namespace

std::string listing(const char* noun, const char* plural, std::span<const std::int64_t> ids) {
  return list(noun, plural, ids.size(), [&](std::size_t i) { return std::to_string(ids[i]); });
}

std::string listing_pairs(const char* noun, const char* plural, std::span<const std::int64_t> ids) {
  return list(noun, plural, ids.size() / 2, [&](std::size_t i) {
    return std::to_string(ids[2 * i]) + "-" + std::to_string(ids[2 * i + 1]);
  });
}

}  // namespace fairing
