// SPDX-License-Identifier: GPL-3.0-or-later
// What a run was predicted to take, for allocations that only save time.
#pragma once

#include <cstddef>

namespace fairing {

constexpr std::size_t small_run = std::size_t(16) << 20;  // bytes that no run is short of

// Sets the prediction of the run whose ledger is open on this thread.
void expect_memory(std::size_t bytes);

// Whether that run stays within twice its prediction, or small, with so many more bytes.
bool is_expected_memory(std::size_t bytes);

}  // namespace fairing
