// SPDX-License-Identifier: GPL-3.0-or-later
// How thick a control mesh is behind each of its faces.
#pragma once

#include <limits>
#include <span>
#include <vector>

#include "mesh/control_mesh.h"
#include "parallel/workers.h"

namespace fairing {

// What a control face has of its plane: that through the middles of a quad's sides.
struct FacePlane {
  Vec3 middle, normal;  // of unit length, or zero
  double area;
};

FacePlane plane_of(const Face& face, std::span<const Vec3> control);

struct Opposite {
  Index face = -1;  // none
  double distance = std::numeric_limits<double>::infinity();
};

// Of each face the next one that looks the other way, straight behind its middle. Behind is where the
// mesh as a whole has its inside; of one that is open, where that would be if it were closed to its
// centre. Copies of faces (ControlMesh::copies) have none, and are none.
std::vector<Opposite> opposite_faces(const ControlMesh& mesh, std::span<const Vec3> control,
                                     std::span<const FacePlane> planes, Workers& workers);

}  // namespace fairing
