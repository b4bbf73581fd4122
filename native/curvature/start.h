// SPDX-License-Identifier: GPL-3.0-or-later
// The start of a level's steps: the candidate with the least total curvature.
#pragma once

#include "curvature/system.h"

namespace fairing {

// Moves the iterate from the level below, whose solution it is, to `level` and on to these pads.
// `plate` and `plate_below` are the thin plate's surfaces of both levels; on the coarsest level
// iterate.current and plate_below are empty. `given` are the positions of the control vertices if
// the mesh is not refined, else empty. The distance from the reference is penalized, by weights from
// the bending of `plate`. Each candidate must have less energy than those before it:
//
//   1. the thin plate's surface; or the given positions, which differ if vertices may move: in the
//      filling of a long tube they are a tube, and the plate a thread;
//   2. the same plus the prolongated change (solution minus plate) of the level below;
//   3. if that is not near the energy of the level below: that level's surface with new midpoints
//      raised along its normals, exact to fourth order;
//   4. if all energies are far above it: its polyhedron, with new midpoints on its edges. On
//      crumpled meshes the plate can diverge, and normals raise midpoints the wrong way (measured:
//      Spot's plate has energies of 2.5e3, 1.1e5 and 2.1e7 on levels 2 to 4; a polyhedron has two
//      to four times the energy of the level below).
//
// Sets plate_energy and start_energy of `report`.
void choose_start(SurfaceIterate& iterate, int level, const Pads* pads, const Array<double>& plate,
                  const Array<double>& plate_below, Reference reference,
                  std::span<const Vec3> given, CurvatureLevelReport& report);

}  // namespace fairing
