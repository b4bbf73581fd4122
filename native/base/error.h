// SPDX-License-Identifier: GPL-3.0-or-later
// The one exception type of the core, the warnings, and how their messages begin. Every refusal
// names its elements: a message is what the user reads, the ids are what the add-on selects.
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

// The stable upper-case spelling that scripts see, "NONMANIFOLD_EDGE".
const char* name(ErrorCode code);

// What a list of ids names. Edges are vertex pairs, laid end to end.
enum class ElementKind { mesh, vertex, edge, face };

const char* name(ElementKind kind);

// The kind of that name; mesh for any other text.
ElementKind kind_named(std::string_view text);

// What the elements of such an error usually are.
ElementKind usual_kind(ErrorCode code);

// `elements` are ids in the caller's own numbering, of the kind that `kind` says.
class FairingError : public std::runtime_error {
 public:
  FairingError(ErrorCode error, const std::string& message, std::vector<std::int64_t> ids = {})
      : FairingError(error, message, std::move(ids), usual_kind(error)) {}
  FairingError(ErrorCode error, const std::string& message, std::vector<std::int64_t> ids,
               ElementKind of)
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
  std::string code;  // of an ErrorCode, as "ISOLATED_VERTICES", or "NOT_CONVERGED"
  std::string message;
  std::vector<std::int64_t> elements;
  ElementKind kind = ElementKind::mesh;
};

// How messages begin: the count of elements, the first few ids, and the verb in agreement.
struct Words {
  const char *one, *many;
};

constexpr Words face_s{"face", "faces"}, vertex_s{"vertex", "vertices"}, edge_s{"edge", "edges"},
    crease_s{"crease", "creases"};

// "1 face (7) has", "12 faces (0, 4, 9, 11, 12, …) have".
std::string listing(Words noun, std::span<const std::int64_t> ids, Words verb);

// Ids laid end to end in pairs: "2 edges (0-4, 4-9) have".
std::string listing_pairs(Words noun, std::span<const std::int64_t> ids, Words verb);

// A message about other ids: its first listing and the verbs after that agree with their number.
// One that lists nothing comes back as it is.
std::string relisted(const std::string& message, ElementKind kind,
                     std::span<const std::int64_t> ids);

}  // namespace fairing
