// SPDX-License-Identifier: GPL-3.0-or-later
// What is between the two rims of a ring.
#pragma once

#include <functional>

#include "mesh/fill/refine.h"

namespace fairing {

// Fills a patch of two rims, of which the second one begins at `second`: triangles with a side on one
// rim and a corner on the other, of the least sum of squared lengths across [Fuchs, Kedem and Uselton
// 1977]. Where these turn sharply against one another or the faces behind, and `bends`, the lines
// across are bent as those faces go on, and have points of their own as far apart as is wanted, if that
// turns less. False, and nothing done, where the points that may be joined allow none, or there are
// folds between the triangles: such a ring is not straight. Throws FairingError(too_large).
bool fill_ring(Patch& patch, std::size_t second, bool bends,
               const std::function<bool(std::size_t, std::size_t)>& may_join);

}  // namespace fairing
