// SPDX-License-Identifier: GPL-3.0-or-later
// Triangles of the density that the rim of a hole has, as equilateral as the rim allows.
#pragma once

#include <functional>
#include <vector>

#include "base/types.h"
#include "mesh/fill/triangulate.h"

namespace fairing {

// What fills one hole. Triangles, and no edge or vertex with more of them around than a surface has.
struct Patch {
  std::vector<Vec3> points;
  std::vector<double> lengths;  // of edges wanted at each point
  Index rim = 0;                // so many points, the first, stay where they are
  std::vector<Triangle> triangles;
  // Of each point of the rim the normal, of unit length or zero, of the face behind the side from it
  // to the next. Empty: there are none.
  std::vector<Vec3> rim_normals;
};

constexpr std::size_t largest_filling = 100'000'000;  // vertices, as the message has it

// Throws FairingError(too_large): more than those.
[[noreturn]] void too_dense();

enum class Relaxation {
  taut,     // as a membrane over the rim: for the flat pieces of a first triangulation
  sliding,  // along the surface, which keeps its shape
  curved    // the same, and edges are split beside their chords: for a surface that is fair
};

// Splits long edges, collapses short ones, flips for larger angles and relaxes, in turn until
// nothing is too long [Botsch and Kobbelt 2004]. `joined`: whether two points of the rim have an
// edge elsewhere, so that they must not get a second one. The rim's points come back first, in their
// order. Deterministic. Throws FairingError(too_large) beyond a hundred million points.
void refine(Patch& patch, const std::function<bool(Index, Index)>& joined, Relaxation relaxation);

}  // namespace fairing
