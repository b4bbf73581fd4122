// SPDX-License-Identifier: GPL-3.0-or-later
// Where faces that cannot move meet others, as at the rim of a filling.
//
// A surface of least total curvature leaves them with their tangent planes, but not with their
// curvature M_h. The rim's own M is the mean of both sides, s M_h + (1 - s) M', which loses the
// energy s (1 - s) |M' - M_h|^2 an area: a jump of curvature would cost too little, by a share that
// falls only as the length of an edge. So the energy of the rim's free side is taken, with
// M' = (M - s M_h) / (1 - s); that of the other side is constant.
//
// Noise makes jumps of its own, which M' doubles. So s is less by the share of noise in |M_h|^2.
#pragma once

#include <vector>

#include "curvature/point_curvature.h"
#include "grid/accumulate.h"
#include "grid/grid_level.h"

namespace fairing {

struct HeldSide {
  double share = 0;           // s: of the area around a vertex, that of faces that cannot move
  Vec3 shape = Vec3::Zero();  // M_h, in the vertex' chart from its axis
};

// Of the vertices of a mesh that is not refined, about the surface x; empty if there is none. M_h is
// the mean over those neighbours around which nothing can move, and its noise how much these differ
// from each other, along the whole rim.
std::vector<HeldSide> held_sides(const GridLevel& grid, const Unknowns& unknowns, const double* x);

}  // namespace fairing
