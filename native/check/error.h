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
  isolated_vertices,
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

// What a list of ids names. Edges are vertex pairs, laid end to end.
enum class ElementKind { mesh, vertex, edge, face };

const char* name(ElementKind kind);

// What the elements of such an error are, unless it says otherwise.
ElementKind usual_kind(ErrorCode code);

// `elements` are ids in the caller's own numbering, of the kind that `kind` says.
class FairingError : public std::runtime_error {
 public:
  FairingError(ErrorCode error, const std::string& message, std::vector<std::int64_t> ids = {})
      : FairingError(error, message, std::move(ids), usual_kind(error)) {}
  FairingError(ErrorCode error, const std::string& message, std::vector<std::int64_t> ids, ElementKind of)
      : std::runtime_error(message),
        code(error),
        kind(ids.empty() ? ElementKind::mesh : of),
        elements(std::move(ids)) {}

  ErrorCode code;
  ElementKind kind;
  std::vector<std::int64_t> elements;
};

// Something that the user should know and that stops nothing.
struct Warning {
  std::string code;  // "ISOLATED_VERTICES", "COINCIDENT_VERTICES", …
  std::string message;
  std::vector<std::int64_t> elements;
  ElementKind kind = ElementKind::mesh;
};

}  // namespace fairing
