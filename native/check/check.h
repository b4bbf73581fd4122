// SPDX-License-Identifier: GPL-3.0-or-later
// The gate: whatever passes `check` is an oriented manifold of polygons with finite, non-degenerate faces.
#pragma once

#include <vector>

#include "check/error.h"
#include "check/polygon_mesh.h"

namespace fairing {

struct CheckOptions {
  bool repair_orientation = false;  // flip faces to agree with their neighbours where that is possible
};

struct CheckResult {
  std::vector<Warning> warnings;
  std::vector<std::int64_t> flipped_faces;  // what repair_orientation has turned over
};

// Looks for every defect, cheap ones first, and throws FairingError at the first kind found, with *all*
// elements of that kind. The arrays are only read; with repair_orientation the faces to be reversed come
// back in the result (ControlMesh takes them). Linear time up to hashing and sorting.
CheckResult check(const PolygonMesh& mesh, const CheckOptions& options = {});

}  // namespace fairing
