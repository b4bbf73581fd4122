// SPDX-License-Identifier: GPL-3.0-or-later
// Warnings of a run: more memory than predicted, straight lines in place of curves, not converged,
// a body thicker or thinner than the mesh.
#pragma once

#include <string>

#include "fairing/options.h"
#include "fairing/report.h"
#include "grid/grid_level.h"
#include "parallel/memory.h"
#include "parallel/workers.h"

namespace fairing {

// Tells the observer that a run is about to take more memory than predicted.
void expect_memory(const Report& report);

// Reports the peak, with a warning if the run has taken clearly more than predicted.
void warn_of_memory(const MemoryLedger& ledger, Report& report);

// Adds a warning that names these control edges, if any: their curves are straight because the
// faces beside them are too narrow.
void warn_straightened(const ControlMesh& mesh, const std::vector<Index>& edges, Report& report);

// Adds a warning if the surface has not converged (Report::converged()), with its level, the
// remaining error and advice, which depends on the warnings before. Its code begins with
// NOT_CONVERGED and says why.
void warn_unconverged(const FairOptions& options, Report& report);

// Adds a warning if the surface x on the finest level, in working coordinates, is thicker or
// thinner than the control mesh (grid/thickness.h), with the faces, the amount and advice; or, if
// the distance from it is penalized, than the subdivision surface, `subdivided`; else null.
void warn_of_thickness(const GridLevel& grid, Workers& workers, const double* x,
                       const double* subdivided, const FairOptions& options, Report& report);

}  // namespace fairing
