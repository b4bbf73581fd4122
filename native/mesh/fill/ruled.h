// SPDX-License-Identifier: GPL-3.0-or-later
// Fills the ring between two rims.
#pragma once

#include <functional>

#include "mesh/fill/refine.h"

namespace fairing {

// Fills a patch of two rims, of which the second one begins at `second`: triangles with a side on
// one rim and a corner on the other, of the least sum of squared lengths across [Fuchs, Kedem and
// Uselton 1977]. If these turn sharply against one another or the faces behind, and `bends`, the
// lines across are bent as those faces continue, with points of their own at the requested
// distance, if that turns less. False, without changes, if the allowed pairs of points give no
// triangulation or the triangles fold: such a ring is not straight. Throws FairingError(too_large).
bool fill_ring(Patch& patch, std::size_t second, bool bends,
               const std::function<bool(std::size_t, std::size_t)>& may_join);

}  // namespace fairing
