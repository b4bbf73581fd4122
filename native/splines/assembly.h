// SPDX-License-Identifier: GPL-3.0-or-later
// Fitted curves and patches, put together: edges, vertices, loops, and the angles at edges.
#pragma once

#include "splines/fit.h"

namespace fairing {

// Everything of `out` but angles and turns of the lattice.
void assemble(const Lattice& lattice, const Topology& topology,
              const std::vector<FittedCurve>& curves, std::vector<FittedPatch>& patches,
              SplineSurface& out);

// angles_an_edge an edge as assemble() numbers them, radians; NaN where no two patches meet
// smoothly, and at the tips of sharp kinks.
std::vector<double> edge_angles(const Topology& topology, const std::vector<FittedPatch>& patches,
                                const std::vector<FittedCurve>& curves, Workers& workers);

// Of a patch: where it needs more spans.
struct Directions {
  bool u = false, v = false;

  bool any() const { return u || v; }
};

// By patches: along which of its edges with too sharp an angle one is off by a half of it.
std::vector<Directions> patches_to_refine(const Topology& topology,
                                          const std::vector<FittedPatch>& patches,
                                          const std::vector<FittedCurve>& curves, double tolerance,
                                          Workers& workers);

}  // namespace fairing
