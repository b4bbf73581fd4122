// SPDX-License-Identifier: GPL-3.0-or-later
// Fitted curves and patches, put together: edges, vertices, loops, and how patches meet at edges.
#pragma once

#include "splines/fit.h"

namespace fairing {

// What has been fitted.
struct Fits {
  const Lattice& lattice;
  const Topology& topology;
  const std::vector<FittedCurve>& curves;
  std::vector<FittedPatch>& patches;
  Workers& workers;
};

// Everything of `out` but turns of the lattice. Takes the patches.
void assemble(const Fits& fits, SplineSurface& out);

// Of a patch: where it needs more spans.
struct Directions {
  bool u = false, v = false;

  bool any() const { return u || v; }
};

// By patches: along which of its edges with too sharp an angle one is off by a half of it.
std::vector<Directions> patches_to_refine(const Fits& fits, double tolerance);

}  // namespace fairing
