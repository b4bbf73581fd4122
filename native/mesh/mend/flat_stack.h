// SPDX-License-Identifier: GPL-3.0-or-later
// Flat faces that span one side, of which there may be hundreds: they are removed together, and
// their vertices are sorted once. For mesh/mend/ only.
#pragma once

#include <span>
#include <vector>

#include "mesh/mend/cut_sides.h"

namespace fairing {

// The longest side of a face; of equal ones any.
CutSide longest_side(std::span<const double> coordinates, std::span<const MendCorner> loop);

// Whether a face has the side, and all its other vertices strictly inside it.
bool spans(std::span<const double> coordinates, std::span<const MendCorner> loop,
           const CutSide& side);

// The cuts of the side that all the faces span, which comes first, and of their other sides, by the
// vertices of all. A side from one of its ends has the nearest vertex only: the cut of its rest has
// the next.
std::vector<CutSide> cuts_of_stack(std::span<const double> coordinates,
                                   std::span<const Loop> faces);

}  // namespace fairing
