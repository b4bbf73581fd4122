// SPDX-License-Identifier: GPL-3.0-or-later
// Where a level's steps start: the surface of least total curvature among a few.
#pragma once

#include "curvature/system.h"

namespace fairing {

// iterate <- the thin plate's surface of a level, symmetrized. Not linearized.
void start_at_plate(SurfaceIterate& iterate, int level, const Array<double>& plate);

// Takes the iterate from the level below, whose solution it holds, to `level` and on to these pads.
// `plate` and `plate_below` are the thin plate's surfaces of both levels; on the coarsest level
// iterate.current and plate_below are empty. `given` are the control vertices' own places on a mesh
// that is not refined, else empty. Candidates, of which each has to have less energy than those before:
//
//   1. the thin plate's surface; or the given places, which differ where vertices may move: a filling
//      of a long tube is one, and the plate a thread;
//   2. the same plus the prolongated change (solution minus plate) of the level below;
//   3. where that is not near the level below's energy: its surface with new midpoints bulged along
//      its normals (transfer/point_normal.h), exact to fourth order;
//   4. where all are far above that energy: its polyhedron, new midpoints halfway. On crumpled
//      meshes the plate can run wild, and normals bulge nothing the right way (measured: Spot's
//      plate has energies of 2.5e3, 1.1e5 and 2.1e7 on levels 2 to 4; a polyhedron has two to four
//      times that of the level below).
//
// Sets plate_energy and start_energy of `report`.
void choose_start(SurfaceIterate& iterate, int level, Pads* pads, const Array<double>& plate,
                  const Array<double>& plate_below, std::span<const Vec3> given,
                  CurvatureLevelReport& report);

}  // namespace fairing
