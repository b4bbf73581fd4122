// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <gtest/gtest.h>

#include "base/error.h"

namespace fairing::test {

// The FairingError that `action` throws; fails the test if it throws none.
template <class Action>
FairingError thrown(Action action) {
  try {
    action();
  } catch (const FairingError& error) {
    return error;
  }
  ADD_FAILURE() << "nothing was thrown";
  return FairingError(ErrorCode::cancelled, "");
}

}  // namespace fairing::test
