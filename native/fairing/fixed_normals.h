// SPDX-License-Identifier: GPL-3.0-or-later
// Which of the caller's normals can be fixed.
#pragma once

#include <numbers>
#include <vector>

#include "constraints/couples.h"
#include "fairing/options.h"
#include "fairing/report.h"

namespace fairing {

struct ChosenNormals {
  std::vector<FixedNormal> fixed;  // at input vertices and their copies
  std::size_t vertices = 0;        // number of input vertices among them
  std::vector<std::int64_t> left;  // input vertices on curves and where sheets touch: not fixed
};

constexpr double degree = std::numbers::pi / 180;

// Normals outside a region and at vertices without faces are ignored. May throw
// FairingError(cancelled).
ChosenNormals choose_normals(const ControlMesh& mesh, const FairOptions& options);

// Throws FairingError(bad_option), naming the vertices, if a normal is so far from that of the
// control faces around it that the surface would have to stand on edge.
void require_near(const ControlMesh& mesh, const std::vector<FixedNormal>& normals);

// Reports the normals of a surface that ended with `finest`: their number, the largest remaining
// angle, and a warning for those that are not fixed.
void report_normals(const ChosenNormals& normals, const LevelReport& finest, Report& report);

}  // namespace fairing
