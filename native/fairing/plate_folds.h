// SPDX-License-Identifier: GPL-3.0-or-later
// Removes folds from a thin plate's surface. Its three coordinates are solved separately, so its
// energy does not prevent folds: where small faces meet large ones, points may overtake one another
// along the surface.
#pragma once

#include "fairing/problem.h"

namespace fairing {

// A linear map of surfaces that removes the folds.
struct PlateRepair {
  Array<float> filled;  // per point of the finest level; nonzero where it is placed again
  // Control edges whose curve folded the faces beside it, and is straight now.
  std::vector<Index> straightened{};

  bool any() const { return !filled.empty(); }
};

// Removes the folds that the control mesh does not have: the distance of the points around them
// from the control polyhedron is filled (fill_harmonically), then farther around those that remain.
// Without folds, and where filling leaves as many, the surface stays bit for bit. 3 numbers a point
// of the finest level, in working coordinates. May throw FairingError(cancelled).
PlateRepair repair_plate_folds(const FairingProblem& problem, const ControlPositions& control,
                               const GridLevel& grid, Array<double>& surface);

// The same for another surface, with the places and weights of an earlier one.
void apply_plate_repair(const FairingProblem& problem, const ControlPositions& control,
                        const GridLevel& grid, const PlateRepair& repair, Array<double>& surface);

}  // namespace fairing
