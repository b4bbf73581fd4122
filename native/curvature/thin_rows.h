// SPDX-License-Identifier: GPL-3.0-or-later
// Straight rows across thin faces, as the start of minimum variation.
//
// Rows of the thin plate are bent in slivers, by a fixed share of their length, since its metric
// opens narrow angles. A point's neighbours across a face, w away, then lie d to one side of it,
// and along the face, l away, the surface leaves a quadratic by l^3. The curvature across errs by
// l^2 d / w^2, which grows with l / w and jumps from point to point. Steps along the normals cannot
// undo that: they bend the surface until its neighbours err alike.
#pragma once

#include "curvature/system.h"

namespace fairing {

// Moves points inside thin faces along the surface to the chords of their rows, and linearizes it
// again. Thin are strips and fans: faces twice as long as wide (gradually, up to three times) whose
// neighbours along their length are thin too. Single slivers stay. Returns whether any face is thin.
bool straighten_thin_rows(SurfaceIterate& iterate);

}  // namespace fairing
