// SPDX-License-Identifier: GPL-3.0-or-later
// The one exception type of the core. Every refusal names its elements.
#pragma once

#include <cstdint>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace fairing {

enum class ErrorCode {
  empty_mesh,
  no_faces,
  bad_shape,
  non_finite,
  index_out_of_range,
  repeated_vertex,
  duplicate_face,
  nonmanifold_edge,
  nonmanifold_vertex,
  inconsistent_orientation,
  non_orientable,
  degenerate_face,
  coincident_vertices,
  bad_feature_edge,
  bad_option,
  underdetermined,
  too_large,
  out_of_memory,
  not_converged,
  cancelled,
};

// The stable upper-case spelling that scripts see, "NONMANIFOLD_EDGE".
const char* name(ErrorCode code);

// `elements` are ids in the caller's own numbering: of faces, of vertices, or of vertex pairs laid
// end to end, as the message says.
class FairingError : public std::runtime_error {
 public:
  FairingError(ErrorCode kind, const std::string& message, std::vector<std::int64_t> ids = {})
      : std::runtime_error(message), code(kind), elements(std::move(ids)) {}

  ErrorCode code;
  std::vector<std::int64_t> elements;
};

// Something that the user should know and that stops nothing.
struct Warning {
  std::string code;  // "ISOLATED_VERTICES", "COINCIDENT_VERTICES", …
  std::string message;
  std::vector<std::int64_t> elements;
};

}  // namespace fairing
