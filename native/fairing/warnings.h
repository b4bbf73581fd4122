// SPDX-License-Identifier: GPL-3.0-or-later
// What a run says of itself: that it takes more memory than was predicted, has straight lines
// in the place of curves, has not converged, or has made a body thicker or thinner.
#pragma once

#include <string>

#include "fairing/options.h"
#include "fairing/report.h"
#include "grid/grid_level.h"
#include "parallel/memory.h"
#include "parallel/workers.h"

namespace fairing {

// Who watches is told of a run that is about to take more than the report predicts.
void expect_memory(const Report& report);

// Reports the peak, with a warning when the run has taken markedly more than was predicted.
void warn_of_memory(const MemoryLedger& ledger, Report& report);

// Adds a warning that names these control edges, if there are any: their curves are straight lines,
// since the faces beside them are too narrow.
void warn_straightened(const ControlMesh& mesh, const std::vector<Index>& edges, Report& report);

// Adds a warning to `report` when a surface has not converged (Report::converged()), with its level,
// what is left and what to do; `of` begins it. Its code, which begins with NOT_CONVERGED, says why.
// `surface` may be the same report.
void warn_unconverged(const Report& surface, const FairOptions& options, const std::string& of,
                      Report& report);

// Adds a warning where the surface x on the finest level, in working coordinates, is thicker or thinner
// than the control mesh with its vertices where the surface has them (grid/thickness.h), with the
// faces, by how much, and what to do.
void warn_of_thickness(const GridLevel& grid, Workers& workers, const double* x,
                       const FairOptions& options, Report& report);

}  // namespace fairing
