// SPDX-License-Identifier: GPL-3.0-or-later
// Polygons that no centre sees: cut along the diagonals of the best triangulation.
#pragma once

#include <functional>
#include <vector>

#include "control_mesh/polygon_shape.h"

namespace fairing {

// The corners of one piece, ascending.
using Piece = std::vector<std::size_t>;

// The triangulation of least total badness by dynamic programming, using only the diagonals (i, j) that are
// allowed. Where several triangulations are equally good (to 1e-6), only the diagonals that all of them
// share are cut, and the piece between stays whole: a preference by order would break the polygon's
// symmetry. So the result depends neither on the first corner nor on mirroring; without any triangulation
// it is the whole polygon. Cubic in the number of corners.
std::vector<Piece> cut_polygon(const PolygonShape& shape,
                               const std::function<bool(std::size_t, std::size_t)>& allowed);

}  // namespace fairing
