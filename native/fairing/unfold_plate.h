// SPDX-License-Identifier: GPL-3.0-or-later
// Taking folds out of a thin plate's surface. Its three coordinates are solved each for itself, so
// nothing in its energy keeps faces upright: where small faces meet large ones, points may overtake
// one another along the surface.
#pragma once

#include "fairing/problem.h"

namespace fairing {

// What it takes, which is a linear map of surfaces.
struct PlateRepair {
  Array<float> filled;  // one a point of the finest level, above zero where it is placed anew
  // Control edges whose curve folded the faces beside it, and is straight now.
  std::vector<Index> straightened{};

  bool any() const { return !filled.empty(); }
};

// Takes the folds that the control mesh has not out of the surface: around them points go where they
// are in order (fill_harmonically), then farther around those that are left. Where none are near, and
// where some would be left even so, the surface stays to the last bit. 3 numbers a point of the finest level, in working coordinates.
// May throw FairingError(cancelled).
PlateRepair unfold_plate(const FairingProblem& problem, const ControlPositions& control,
                         const GridLevel& grid, Array<double>& surface);

// The same for another surface, with the places and weights of an earlier one.
void unfold_alike(const FairingProblem& problem, const ControlPositions& control,
                  const GridLevel& grid, const PlateRepair& repair, Array<double>& surface);

}  // namespace fairing
