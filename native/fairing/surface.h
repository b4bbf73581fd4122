// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "thin_plate/plate_state.h"

namespace fairing {

// A surface as solved: 3 numbers a point, in working coordinates.
struct Surface {
  Array<double> plate;     // the thin plate's
  PlateState state;        // loads and targets that hold it
  Array<double> curved{};  // that of a curvature energy, found by steps from the plate; else empty

  Array<double>& points() { return curved.empty() ? plate : curved; }
  const Array<double>& points() const { return curved.empty() ? plate : curved; }
};

}  // namespace fairing
