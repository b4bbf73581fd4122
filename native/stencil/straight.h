// SPDX-License-Identifier: GPL-3.0-or-later
// Faces that stay straight in one direction, as those around a cylinder (mesh/flat_faces.h): the
// second difference in that direction counts as much as on flat faces. The file also weights the
// edges between such faces and soft ones.
#pragma once

#include <array>
#include <span>

#include "grid/runs.h"
#include "stencil/chart.h"
#include "stencil/fit.h"

namespace fairing {

// The side of a line of edges through a point on which the faces do not bend across it, while those
// on the other side do: the line, with that side on its left, zero if there is none, and the
// places of that side's points in the ring, modulo its size.
struct StiffSide {
  Vec2 line = Vec2::Zero();
  std::size_t begin = 0, end = 0;
  bool any() const { return line != Vec2::Zero(); }
};
StiffSide stiff_side(const ControlMesh& mesh, const Element& element, const Chart& chart);

// Draws the points of the stiff side, on which the surface is linear, to the centre, until the ring
// reaches as far as on the other side: a rim beside a face a hundred times as wide would not
// determine a quadratic, so that the edge would be a hinge. Returns their factor, at most 1: their
// differences shrink with it.
double shorten(const StiffSide& side, Chart& chart);

// fit() and basis() of a quadratic that is linear across the line on the stiff side, so that values
// between points bend no stiff face; `share` of the way to neighbour j.
FitRows fit_beside(const StiffSide& side, const Chart& chart);
Coefficients basis_beside(const StiffSide& side, const Chart& chart, std::size_t j, double share);

// Multiplies the second difference in the direction in which an element's faces are straight; none
// if not all of them are flat. An edge between two of them is straight itself. `hessians`: the last
// three of fit()'s coefficients (stencil/fit.h), one set a neighbour.
void stiffen_straight(const ControlMesh& mesh, const Element& element, const Chart& chart,
                      std::span<std::array<double, 3>> hessians);

// Multiplies the second difference across the line by the harmonic mean of the stiffness of both
// sides: else it would be a hinge as wide as the stiff face's cells.
void stiffen_across(const StiffSide& side, const Chart& chart,
                    std::span<std::array<double, 3>> hessians);

}  // namespace fairing
