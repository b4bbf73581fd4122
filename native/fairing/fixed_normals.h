// SPDX-License-Identifier: GPL-3.0-or-later
// At which control vertices the caller's normals can be fixed.
#pragma once

#include <numbers>
#include <vector>

#include "constraints/couples.h"
#include "fairing/options.h"
#include "fairing/report.h"

namespace fairing {

struct ChosenNormals {
  std::vector<FixedNormal> fixed;  // of input vertices and their copies
  std::size_t vertices = 0;        // of the input, that have one of these
  std::vector<std::int64_t> left;  // input vertices on curves and where sheets touch: not fixed
};

constexpr double degree = std::numbers::pi / 180;

// Outside a region normals are nothing, and so are those at vertices without faces. May throw
// FairingError(cancelled).
ChosenNormals choose_normals(const ControlMesh& mesh, const FairOptions& options);

// Throws FairingError(bad_option), naming the vertices, where a normal is so far from that of the
// control faces around, in `mesh`, that the surface would have to stand on edge.
void require_near(const ControlMesh& mesh, const std::vector<FixedNormal>& normals);

// What came of them in a surface that ended with `finest`: how many, the largest angle that is left,
// and a warning of those that are not fixed.
void report_normals(const ChosenNormals& normals, const LevelReport& finest, Report& report);

}  // namespace fairing
