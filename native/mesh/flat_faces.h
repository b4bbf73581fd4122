// SPDX-License-Identifier: GPL-3.0-or-later
// Marks the elements of a control mesh that belong to flat faces.
#pragma once

#include <span>

#include "mesh/control_mesh.h"

namespace fairing {

// Fills `flat` of a mesh with complete rings. Chosen faces in one plane are a part. Where it meets
// others at folds that are not sharp, as around a cylinder or a cone, it is straight along them: if
// they are about parallel, and it is at most twice as wide as a part beside it. So the sides of a
// rounded box stay plane, and its rims straight.
// Throws FairingError(index_out_of_range) for missing faces.
void mark_flat_faces(std::span<const std::int64_t> faces, ControlMesh& control);

// Takes plane parts out of the region, whose vertices do not move: their points are given then, and
// what is around them is tangent to them. Parts beside curves, with which their points move, stay.
// Outlines that are smooth become curves (mesh/flat_outlines.h).
void hold_flat_parts(ControlMesh& control);

// A vertex is flat if all faces around it lie in one plane. A face is `amid` flats if all its
// corners are flat, so that the limit surface of subdivision is flat there. It is `beside` them if a
// corner and a neighbour of that by an edge are flat, off borders: a single flat vertex, as in a fan
// of triangles or a triangulated cube, is none.
enum class Flatness : std::uint8_t { none, beside, amid };

// One a face.
std::vector<Flatness> flatness(const ControlMesh& control);

}  // namespace fairing
