// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "lattice/accumulate.h"

namespace fairing {

// Marks (above zero) the neighbours of marked points as well; those that are no unknowns lose theirs, unless `unknowns` is
// null.
void grow(const Lattice& lattice, Workers& workers, Exchange<float, 1>& exchange, const Unknowns* unknowns,
          Array<float>& marks);

}  // namespace fairing
