// SPDX-License-Identifier: GPL-3.0-or-later
// Fold repair. Folds lie along the surface, so displacements along its normals do not remove them:
// the places with folds are filled again in the start, and the steps are repeated.
#pragma once

#include "curvature/folds.h"
#include "curvature/steps.h"

namespace fairing {

// Gives marked points (above zero) that are unknowns the positions on the surface x that are
// harmonic with the mean value weights [Floater 2003] of `shape`; other points stay. The weights
// are positive and reproduce linear maps of a flat `shape`, so if the surrounding surface is not
// folded, the filling is not either. 3 numbers a point. If the matrix is singular, x stays.
void fill_harmonically(const GridLevel& grid, const Unknowns& unknowns, const Array<float>& marks,
                       const double* shape, double* x);

// Folds of the present surface that the control mesh does not have.
Folds folds_of(const SurfaceIterate& iterate);

// Tries to replace iterate.current, the end of the damped steps from `start`, by a surface with
// fewer folds and hardly more energy, or with much less energy. Sets folds_before and folds of
// `report`, or replaces it.
void repair_folds(SurfaceIterate& iterate, const StepStart& start, CurvatureLevelReport& report);

}  // namespace fairing
