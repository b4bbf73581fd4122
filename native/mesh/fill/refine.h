// SPDX-License-Identifier: GPL-3.0-or-later
// Triangles with the density of a hole's rim, as equilateral as the rim allows.
#pragma once

#include <functional>
#include <vector>

#include "base/types.h"
#include "mesh/fill/triangulate.h"

namespace fairing {

// The filling of one hole: manifold triangles.
struct Patch {
  std::vector<Vec3> points;
  std::vector<double> lengths;  // of edges requested at each point
  Index rim = 0;                // so many first points, which stay
  std::vector<Triangle> triangles;
  // For each point of the rim the normal, of unit length or zero, of the face behind the side from
  // it to the next. Empty: none.
  std::vector<Vec3> rim_normals;
};

constexpr std::size_t largest_filling = 100'000'000;  // vertices, as in the message

// Throws FairingError(too_large): more than these.
[[noreturn]] void too_dense();

enum class Relaxation {
  taut,     // like a membrane over the rim: for the flat pieces of a first triangulation
  sliding,  // along the surface, which keeps its shape
  curved    // the same, and edges are split beside their chords: for a fair surface
};

// Splits long edges, collapses short ones, flips for larger angles and relaxes, in turn until no
// edge is too long [Botsch and Kobbelt 2004]. `joined`: whether two points of the rim have an edge
// elsewhere, so that they must not get a second one. The rim's points come first in the result, in
// their order. Deterministic. Throws FairingError(too_large) beyond a hundred million points.
void refine(Patch& patch, const std::function<bool(Index, Index)>& joined, Relaxation relaxation);

}  // namespace fairing
