// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/error.h"

#include <algorithm>
#include <optional>

namespace fairing {
namespace {

constexpr std::size_t shown = 5;  // ids in a message, which fit on one line

struct Noun {
  std::string_view one, many;
};
constexpr Noun nouns[] = {{"face", "faces"},
                          {"vertex", "vertices"},
                          {"edge", "edges"},
                          {"crease", "creases"},
                          {"boundary edge", "boundary edges"}};

std::string listed(const Noun& noun, ElementKind kind, std::span<const std::int64_t> ids) {
  const std::size_t each = kind == ElementKind::edge ? 2 : 1, count = ids.size() / each;
  std::string out = std::to_string(count) + " " + std::string(count == 1 ? noun.one : noun.many);
  for (std::size_t i = 0; i < std::min(count, shown); ++i) {
    out.append(i ? ", " : " (").append(std::to_string(ids[each * i]));
    if (each == 2) out.append("-").append(std::to_string(ids[2 * i + 1]));
  }
  return out + (count > shown ? ", …)" : ")");
}

// The replacement of a placeholder, "12 faces (0, 4, 9, 11, 12, …)" for "face", or "4-9" for an
// edge; nothing if the braces are ordinary text.
std::optional<std::string> filled(std::string_view place, ElementKind kind,
                                  std::span<const std::int64_t> ids) {
  for (const std::string_view field : {"length:", "setting:"})
    if (place.starts_with(field)) return std::string(place.substr(field.size()));
  if (ids.empty()) return std::nullopt;
  if (const std::size_t bar = place.find('|'); bar != place.npos) {
    const bool single = ids.size() == (kind == ElementKind::edge ? 2u : 1u);
    return std::string(single ? place.substr(0, bar) : place.substr(bar + 1));
  }
  for (const Noun& noun : nouns)
    if (place == noun.one) return listed(noun, kind, ids);
  return std::nullopt;
}

}  // namespace

const char* name(ErrorCode code) {
  switch (code) {
    case ErrorCode::empty_mesh: return "EMPTY_MESH";
    case ErrorCode::no_faces: return "NO_FACES";
    case ErrorCode::bad_shape: return "BAD_SHAPE";
    case ErrorCode::non_finite: return "NON_FINITE";
    case ErrorCode::index_out_of_range: return "INDEX_OUT_OF_RANGE";
    case ErrorCode::repeated_vertex: return "REPEATED_VERTEX";
    case ErrorCode::duplicate_face: return "DUPLICATE_FACE";
    case ErrorCode::nonmanifold_edge: return "NONMANIFOLD_EDGE";
    case ErrorCode::nonmanifold_vertex: return "NONMANIFOLD_VERTEX";
    case ErrorCode::inconsistent_orientation: return "INCONSISTENT_ORIENTATION";
    case ErrorCode::non_orientable: return "NON_ORIENTABLE";
    case ErrorCode::degenerate_face: return "DEGENERATE_FACE";
    case ErrorCode::coincident_vertices: return "COINCIDENT_VERTICES";
    case ErrorCode::isolated_vertices: return "ISOLATED_VERTICES";
    case ErrorCode::bad_feature_edge: return "BAD_FEATURE_EDGE";
    case ErrorCode::bad_option: return "BAD_OPTION";
    case ErrorCode::underdetermined: return "UNDERDETERMINED";
    case ErrorCode::too_extreme: return "TOO_EXTREME";
    case ErrorCode::too_large: return "TOO_LARGE";
    case ErrorCode::out_of_memory: return "OUT_OF_MEMORY";
    case ErrorCode::no_thread: return "NO_THREAD";
    case ErrorCode::forked: return "FORKED";
    case ErrorCode::cancelled: return "CANCELLED";
  }
  return "UNKNOWN";
}

const char* name(ElementKind kind) {
  switch (kind) {
    case ElementKind::mesh: return "mesh";
    case ElementKind::vertex: return "vertex";
    case ElementKind::edge: return "edge";
    case ElementKind::face: return "face";
  }
  return "unknown";
}

ElementKind kind_named(std::string_view text) {
  for (const ElementKind kind : {ElementKind::vertex, ElementKind::edge, ElementKind::face})
    if (text == name(kind)) return kind;
  return ElementKind::mesh;
}

ElementKind usual_kind(ErrorCode code) {
  switch (code) {
    case ErrorCode::bad_shape:
    case ErrorCode::index_out_of_range:
    case ErrorCode::repeated_vertex:
    case ErrorCode::duplicate_face:
    case ErrorCode::inconsistent_orientation:
    case ErrorCode::non_orientable:
    case ErrorCode::degenerate_face:
    case ErrorCode::too_large: return ElementKind::face;
    case ErrorCode::non_finite:
    case ErrorCode::nonmanifold_vertex:
    case ErrorCode::coincident_vertices:
    case ErrorCode::isolated_vertices:
    case ErrorCode::bad_option:
    case ErrorCode::too_extreme:
    case ErrorCode::underdetermined: return ElementKind::vertex;
    case ErrorCode::nonmanifold_edge:
    case ErrorCode::bad_feature_edge: return ElementKind::edge;
    case ErrorCode::empty_mesh:
    case ErrorCode::no_faces:
    case ErrorCode::out_of_memory:
    case ErrorCode::no_thread:
    case ErrorCode::forked:
    case ErrorCode::cancelled: return ElementKind::mesh;
  }
  return ElementKind::mesh;
}

std::string text(const std::string& sentence, ElementKind kind, std::span<const std::int64_t> ids) {
  std::string out;
  std::size_t from = 0;
  while (true) {
    const std::size_t open = sentence.find('{', from), close = sentence.find('}', open);
    if (close == std::string::npos) break;
    const auto place = std::string_view(sentence).substr(open + 1, close - open - 1);
    const std::optional<std::string> words = filled(place, kind, ids);
    out.append(sentence, from, words ? open - from : close + 1 - from);
    out += words.value_or("");
    from = close + 1;
  }
  return out.append(sentence, from);
}

std::string text(const Message& message, ElementKind kind, std::span<const std::int64_t> ids) {
  const std::string cause = text(message.cause, kind, ids);
  return message.cure.empty() ? cause : cause + " " + text(message.cure, kind, ids);
}

}  // namespace fairing
