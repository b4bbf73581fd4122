// SPDX-License-Identifier: GPL-3.0-or-later
// The gate: whatever passes `check` is an oriented manifold of polygons with finite, non-degenerate faces.
#pragma once

#include <vector>

#include "check/defect.h"
#include "check/polygon_mesh.h"

namespace fairing {

struct CheckOptions {
  bool repair_orientation = false;  // flip faces to agree with their neighbours where that is possible
};

struct CheckResult {
  std::vector<Warning> warnings;
  std::vector<std::int64_t> flipped_faces;  // what repair_orientation has turned over
};

struct Findings {
  Defects defects;                            // cheap ones first; empty: nothing is wrong
  std::vector<std::int64_t> flipped_faces{};  // what must turn over for all neighbours to agree
};

// Every kind of defect, each with *all* its elements, as far as the earlier ones leave the later tests a meaning.
// Throws nothing.
Findings find_defects(const PolygonMesh& mesh, const CheckOptions& options = {});

// The faces that must turn over for all neighbours to agree. Throws FairingError where that has no answer:
// non_orientable, nonmanifold_edge, or arrays that do not make faces.
std::vector<std::int64_t> faces_to_flip(const PolygonMesh& mesh);

// Throws the first error of find_defects. The arrays are only read; with repair_orientation the faces to be reversed come
// back in the result (ControlMesh takes them). Linear time up to hashing and sorting.
CheckResult check(const PolygonMesh& mesh, const CheckOptions& options = {});

}  // namespace fairing
