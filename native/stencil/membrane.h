// SPDX-License-Identifier: GPL-3.0-or-later
// Tension: a membrane stretched over the control mesh, whose energy is added to a bending energy,
//
//   tau / 2 * (the integral of |grad p|^2 in the control metric) = sum over grid edges ij of
//   w_ij |p_i - p_j|^2,
//
// with linear elements on the flat faces of the metric (stencil/metric.h); a quad counts as the
// mean of its two triangulations. On a conformal map this is tau times the surface's area. The
// integral does not depend on scale, so one set of weights serves every level, and inside a control
// face there is one weight for each direction of its grid.
#pragma once

#include <vector>

#include "parallel/memory.h"
#include "stencil/chart.h"

namespace fairing {

struct MembraneOptions {
  // A membrane that prevents swelling and overshoots: 0 none, 1 the strongest that is of use.
  double tension = 0;
  // For a piece of a larger mesh: its mean edge over that of the whole. Not a setting.
  double edge_ratio = 1;

  // The membrane's factor relative to bending over the length of a control edge.
  double strength() const;
};

// Mean length of the faired edges.
double mean_edge(const ControlMesh& mesh, const std::vector<FlatFace>& flat);

// All w by neighbours, laid out as in Stencils; zero in faces outside a region, none without
// tension. tau = strength / l^2 with l the mean edge in the metric, so that a scaled mesh has the
// scaled surface. Throws FairingError(cancelled).
Array<double> make_membrane(const ControlMesh& mesh, const ChartMaker& charts,
                            const std::vector<std::size_t>& begin, const MembraneOptions& options);

}  // namespace fairing
