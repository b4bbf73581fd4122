// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "curvature/solver.h"
#include "thin_plate/plate_state.h"

namespace fairing {

// A surface as solved: 3 numbers a point, in working coordinates.
struct Surface {
  Array<double> plate;     // the thin plate's
  PlateState state;        // loads and targets that hold it
  CurvedSurface curved{};  // that of a curvature energy, found by steps from the plate, or none

  Array<double>& points() { return curved.points.empty() ? plate : curved.points; }
  const Array<double>& points() const { return curved.points.empty() ? plate : curved.points; }
};

}  // namespace fairing
