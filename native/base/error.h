// SPDX-License-Identifier: GPL-3.0-or-later
// The core's only exception type, warnings, and their messages. Every refusal names its elements:
// users read the message, the add-on selects the ids.
#pragma once

#include <cstdint>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
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
  too_extreme,
  too_large,
  out_of_memory,
  no_thread,
  forked,
  cancelled,
};

// The stable upper-case name for scripts, such as "NONMANIFOLD_EDGE".
const char* name(ErrorCode code);

// What a list of ids names. Edges are vertex pairs, laid end to end.
enum class ElementKind { mesh, vertex, edge, face };

const char* name(ElementKind kind);

// The kind with that name; mesh for any other text.
ElementKind kind_named(std::string_view text);

// The usual kind of elements of such an error.
ElementKind usual_kind(ErrorCode code);

// A message as data, whose text is made last, when ids are the caller's. "{face}" is replaced by the
// elements, "{has|have}" by the word for their number; callers can replace "{length:0.25}" by a
// length in their unit, and "{setting:tension}" by their own name of the setting.
struct Message {
  Message(const char* sentence) : cause(sentence) {}
  Message(std::string sentence, std::string advice = {})
      : cause(std::move(sentence)), cure(std::move(advice)) {}

  std::string cause;  // what is wrong, a sentence
  std::string cure;   // what to do about it, sentences; or empty
};

std::string text(const std::string& sentence, ElementKind kind, std::span<const std::int64_t> ids);
std::string text(const Message& message, ElementKind kind, std::span<const std::int64_t> ids);

// `elements` are ids of the given `kind` in the caller's own numbering.
class FairingError : public std::runtime_error {
 public:
  FairingError(ErrorCode error, const Message& about, std::vector<std::int64_t> ids = {})
      : FairingError(error, about, std::move(ids), usual_kind(error)) {}
  FairingError(ErrorCode error, const Message& about, std::vector<std::int64_t> ids, ElementKind of)
      : std::runtime_error(text(about, of, ids)),
        code(error),
        message(about),
        kind(ids.empty() ? ElementKind::mesh : of),
        elements(std::move(ids)) {}

  ErrorCode code;
  Message message;
  ElementKind kind;
  std::vector<std::int64_t> elements;
};

// A condition that the user should know and that does not stop the run.
struct Warning {
  std::string code;  // the name of an ErrorCode, such as "ISOLATED_VERTICES", or "NOT_CONVERGED"
  Message message;
  std::vector<std::int64_t> elements;
  ElementKind kind = ElementKind::mesh;
};

}  // namespace fairing
