// SPDX-License-Identifier: GPL-3.0-or-later
// Flat faces that span one side, as hundreds may: where they go together, all its vertices are
// sorted once. For mesh/mend/ only.
#pragma once

#include <span>
#include <vector>

#include "mesh/mend/cut_sides.h"

namespace fairing {

// A side of a face, the longest; of equal ones any.
CutSide longest_side(std::span<const double> coordinates, std::span<const MendCorner> loop);

// Whether a face has the side, and all its other vertices strictly inside it.
bool spans(std::span<const double> coordinates, std::span<const MendCorner> loop,
           const CutSide& side);

// The cuts of the side that all the faces span, which comes first, and of their other sides, by the
// vertices of all. A side from one of its ends names the nearest vertex only: the cut of what is left
// of it names the next.
std::vector<CutSide> cuts_of_stack(std::span<const double> coordinates,
                                   std::span<const Loop> faces);

}  // namespace fairing
