// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/error.h"

#include <algorithm>
#include <optional>

namespace fairing {
namespace {

constexpr std::size_t shown = 5;  // ids in a message: a line of text

template <class Item>
std::string list(Words noun, std::size_t count, Item item, Words verb) {
  std::string text = std::to_string(count) + " " + (count == 1 ? noun.one : noun.many) + " (";
  for (std::size_t i = 0; i < std::min(count, shown); ++i) text += (i ? ", " : "") + item(i);
  return text + (count > shown ? ", …) " : ") ") + (count == 1 ? verb.one : verb.many);
}

// Both numbers of an English verb. What is past is the same in both, but for "was".
std::pair<std::string, std::string> both_numbers(const std::string& verb) {
  for (const Words& irregular : {Words{"is", "are"}, Words{"has", "have"}, Words{"was", "were"}})
    if (verb == irregular.one || verb == irregular.many) return {irregular.one, irregular.many};
  if (verb.ends_with('d')) return {verb, verb};
  const std::string stem = verb.ends_with('s') ? verb.substr(0, verb.size() - 1) : verb;
  return {stem + "s", stem};
}

// The noun of a message, if that is one for elements of this kind.
const Words* noun_of(ElementKind kind, const std::string& noun) {
  static constexpr std::pair<ElementKind, Words> nouns[] = {{ElementKind::face, face_s},
                                                            {ElementKind::vertex, vertex_s},
                                                            {ElementKind::edge, edge_s},
                                                            {ElementKind::edge, crease_s}};
  for (const auto& [of, words] : nouns)
    if (of == kind && (noun == words.one || noun == words.many)) return &words;
  return nullptr;
}

// "12 faces (0, 4, …) have" in a message: what it says, and where it begins and ends.
struct Listed {
  std::string noun, verb;
  std::size_t begin, end;
};

std::optional<Listed> find_listed(const std::string& message) {
  const std::size_t open = message.find(" ("), close = message.find(") ", open);
  if (open == std::string::npos || close == std::string::npos) return std::nullopt;
  const std::size_t space = message.rfind(' ', open - 1);
  if (space == std::string::npos) return std::nullopt;
  const auto is_digit = [](char c) { return c >= '0' && c <= '9'; };
  std::size_t begin = space;
  while (begin > 0 && is_digit(message[begin - 1])) --begin;
  if (begin == space) return std::nullopt;
  const std::size_t verb = close + 2, end = std::min(message.find(' ', verb), message.size());
  return Listed{message.substr(space + 1, open - space - 1), message.substr(verb, end - verb),
                begin, end};
}

// The text, with the first of these words, in either number, in the one asked for.
std::string with_number(std::string text, Words words, bool single) {
  const std::string wrong = single ? words.many : words.one;
  if (const std::size_t at = text.find(wrong); at != std::string::npos)
    text.replace(at, wrong.size(), single ? words.one : words.many);
  return text;
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

std::string listing(Words noun, std::span<const std::int64_t> ids, Words verb) {
  return list(noun, ids.size(), [&](std::size_t i) { return std::to_string(ids[i]); }, verb);
}

std::string listing_pairs(Words noun, std::span<const std::int64_t> ids, Words verb) {
  const auto pair = [&](std::size_t i) {
    return std::to_string(ids[2 * i]) + "-" + std::to_string(ids[2 * i + 1]);
  };
  return list(noun, ids.size() / 2, pair, verb);
}

std::string relisted(const std::string& message, ElementKind kind,
                     std::span<const std::int64_t> ids) {
  const std::optional<Listed> found = find_listed(message);
  const Words* noun = found ? noun_of(kind, found->noun) : nullptr;
  if (!noun) return message;
  const auto [one, many] = both_numbers(found->verb);
  const Words verb{one.c_str(), many.c_str()};
  const bool is_edge = kind == ElementKind::edge;
  const std::string start = is_edge ? listing_pairs(*noun, ids, verb) : listing(*noun, ids, verb);
  const bool single = ids.size() == (is_edge ? 2u : 1u);
  return message.substr(0, found->begin) + start +
         with_number(message.substr(found->end), {" and was ", " and were "}, single);
}

}  // namespace fairing
