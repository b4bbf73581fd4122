// SPDX-License-Identifier: GPL-3.0-or-later
// What stays as it is when some grids of faces are cut in two.
#pragma once

#include "splines/topology.h"

namespace fairing {

// By curves and patches: the number of the same one before; -1: there is none.
struct Kept {
  std::vector<Index> curves, patches;
};

// A curve stays if its chain does, or that of the triangle's side where it begins; a patch if its
// grid and the curves on its sides do.
Kept kept_from(const Lattice& lattice, const Topology& before, const Topology& topology);

}  // namespace fairing
