// SPDX-License-Identifier: GPL-3.0-or-later
// Validation: a mesh that passes check() consists of oriented sheets of polygons with finite,
// non-degenerate faces. The arrays are only read.
//
// All functions here may throw FairingError(cancelled) (parallel/cancel.h) and std::bad_alloc.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "base/error.h"
#include "mesh/polygon_mesh.h"

namespace fairing {

enum class Severity { error, warning };

// One kind of defect of a mesh, with all elements concerned.
struct Defect {
  ErrorCode code;
  Message message;
  std::vector<std::int64_t> elements{};
  Severity severity = Severity::error;
  ElementKind kind = ElementKind::mesh;
  // mend() mends it (mesh/mend/mend.h).
  bool repairable = false;

  Defect(ErrorCode what, Message text, std::vector<std::int64_t> ids = {},
         Severity how = Severity::error)
      : code(what),
        message(std::move(text)),
        elements(std::move(ids)),
        severity(how),
        kind(elements.empty() ? ElementKind::mesh : usual_kind(what)),
        repairable(how == Severity::error ? mended(what, kind) : turns_faces(what)) {}

  // CheckOptions::repair mends it.
  static bool turns_faces(ErrorCode what) { return what == ErrorCode::inconsistent_orientation; }

  [[noreturn]] void raise() const { throw FairingError(code, message, elements, kind); }

 private:
  static bool mended(ErrorCode what, ElementKind of);
};

using Defects = std::vector<Defect>;

struct CheckOptions {
  // Flip faces to agree with their neighbours, if possible; mending leaves that to the check.
  bool repair = false;
};

struct CheckResult {
  std::vector<Warning> warnings;
  std::vector<std::int64_t> flipped_faces;  // faces flipped by the repair
};

struct Findings {
  Defects defects;                            // cheap ones first; empty: nothing is wrong
  std::vector<std::int64_t> flipped_faces{};  // faces to flip so that all neighbours agree
};

// Every kind of defect, each with *all* its elements, as far as earlier ones leave later tests
// meaningful. Defects are returned, not thrown.
Findings find_defects(const PolygonMesh& mesh, const CheckOptions& options = {});

// Throws the first error of find_defects as FairingError. With repair, the result has the faces to
// reverse, for make_control_mesh. Linear time up to hashing and sorting.
CheckResult check(const PolygonMesh& mesh, const CheckOptions& options = {});

// Throws bad_shape or too_large if the offsets do not divide the corners into faces. Does not check
// ids or numbers of corners.
void require_faces(std::span<const std::int64_t> corners, std::span<const std::int64_t> offsets);

// Throws the first error of the arrays themselves: sizes, ids, coordinates that are not numbers.
void require_arrays(const PolygonMesh& mesh);

bool repeats_a_vertex(std::span<const std::int64_t> face);

// Vertices with a coordinate that is NaN, infinite or beyond 1e100.
std::vector<std::int64_t> non_finite_vertices(std::span<const double> coordinates);

}  // namespace fairing
