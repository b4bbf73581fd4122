// SPDX-License-Identifier: GPL-3.0-or-later
// Which of the caller's normals can be fixed.
#pragma once

#include <numbers>
#include <vector>

#include "constraints/couples.h"
#include "fairing/control_positions.h"
#include "fairing/options.h"
#include "fairing/report.h"

namespace fairing {

struct ChosenNormals {
  std::vector<FixedNormal> fixed;  // at input vertices and their copies
  std::size_t vertices = 0;        // number of input vertices among them
  // Input vertices on creases, at ends of curves and where sheets touch: not fixed.
  std::vector<std::int64_t> left;
  std::vector<std::int64_t> leaning{};  // input vertices of borders: not at right angles to them
  double largest_lean = 0;              // of these, radians
};

constexpr double degree = std::numbers::pi / 180;

// Up to this angle a normal shows which side of a surface is up; a fixed normal farther from the
// faces around is refused. If the control mesh turns by more, the surface may turn by over 90
// degrees: a cube's does by 96 around its vertices, on point forces.
constexpr double steepest = 80 * degree;

// Normals outside a region and at vertices without faces are ignored. May throw
// FairingError(cancelled).
ChosenNormals choose_normals(const ControlMesh& mesh, const FairOptions& options);

// Turns normals at borders to the nearest ones at right angles to the curve there.
void set_upright(const ControlMesh& mesh, const ControlPositions& control, ChosenNormals& normals);

// Throws FairingError(bad_option), naming the vertices, if a normal is so far from that of the
// control faces around it that the surface would have to stand on edge.
void require_near(const ControlMesh& mesh, const std::vector<FixedNormal>& normals);

// Reports the normals of a surface that ended with `finest`: their number, the largest remaining
// angle, and warnings for those that are not fixed, or not as given.
void report_normals(const ChosenNormals& normals, const LevelReport& finest, Report& report);

}  // namespace fairing
