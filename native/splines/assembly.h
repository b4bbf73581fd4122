// SPDX-License-Identifier: GPL-3.0-or-later
// Assembles fitted curves and patches: edges, vertices, loops, and how patches meet at edges.
#pragma once

#include "splines/fit.h"

namespace fairing {

// The fitted curves and patches.
struct Fits {
  const Lattice& lattice;
  const Topology& topology;
  const std::vector<FittedCurve>& curves;
  std::vector<FittedPatch>& patches;
  Workers& workers;
};

// Sets everything of `out` but the turns of the lattice. Takes over the patches.
void assemble(const Fits& fits, SplineSurface& out);

// The directions in which a patch needs more spans.
struct Directions {
  bool u = false, v = false;

  bool any() const { return u || v; }
};

// For each patch: the directions of those of its edges with too large an angle along which its
// error is at least half of the tolerance.
std::vector<Directions> patches_to_refine(const Fits& fits, double tolerance);

}  // namespace fairing
