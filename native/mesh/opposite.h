// SPDX-License-Identifier: GPL-3.0-or-later
// The thickness of a control mesh behind each of its faces.
#pragma once

#include <limits>
#include <span>
#include <vector>

#include "mesh/control_mesh.h"
#include "parallel/workers.h"

namespace fairing {

// The plane of a control face; of a quad, through the middles of its sides.
struct FacePlane {
  Vec3 middle, normal;  // unit length, or zero
  double area;
};

FacePlane plane_of(const Face& face, std::span<const Vec3> control);

// Whether faces with a common vertex lie in one plane, up to the rounding of single precision.
bool in_one_plane(const FacePlane& a, const FacePlane& b);

struct Opposite {
  Index face = -1;  // none
  double distance = std::numeric_limits<double>::infinity();
};

// For each face the next one straight behind its middle that faces the other way. Behind is where
// the mesh as a whole has its inside; for an open mesh, where that would be if it were closed to
// its centre. Copies of faces (ControlMesh::copies) are ignored.
std::vector<Opposite> opposite_faces(const ControlMesh& mesh, std::span<const Vec3> control,
                                     std::span<const FacePlane> planes, Workers& workers);

}  // namespace fairing
