// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "check/error.h"

namespace fairing {

enum class Severity { error, warning };

// One kind of thing that is wrong with a mesh, with all elements concerned.
struct Defect {
  ErrorCode code;
  std::string message;
  std::vector<std::int64_t> elements{};
  Severity severity = Severity::error;
  ElementKind kind = ElementKind::mesh;

  Defect(ErrorCode what, std::string text, std::vector<std::int64_t> ids = {}, Severity how = Severity::error)
      : code(what),
        message(std::move(text)),
        elements(std::move(ids)),
        severity(how),
        kind(elements.empty() ? ElementKind::mesh : usual_kind(what)) {}

  // The core mends it on request: by CheckOptions::repair_orientation.
  bool repairable() const { return code == ErrorCode::inconsistent_orientation; }

  [[noreturn]] void raise() const { throw FairingError(code, message, elements, kind); }
};

using Defects = std::vector<Defect>;

}  // namespace fairing
