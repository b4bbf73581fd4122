// SPDX-License-Identifier: GPL-3.0-or-later
// How messages name elements: the count, and the first few ids.
#pragma once

#include <cstdint>
#include <span>
#include <string>

namespace fairing {

// "1 face (7)", "12 faces (0, 4, 9, 11, 12, …)".
std::string listing(const char* noun, const char* plural, std::span<const std::int64_t> ids);

// Ids laid end to end in pairs: "2 edges (0-4, 4-9)".
std::string listing_pairs(const char* noun, const char* plural, std::span<const std::int64_t> ids);

}  // namespace fairing
