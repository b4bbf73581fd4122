// SPDX-License-Identifier: GPL-3.0-or-later
#include "check/check.h"

#include "check/arrays.h"
#include "check/geometry.h"
#include "check/half_edges.h"
#include "check/listing.h"
#include "check/orientation.h"
#include "check/topology.h"

namespace fairing {

CheckResult check(const PolygonMesh& mesh, const CheckOptions& options) {
  CheckResult result;
  check_arrays(mesh);
  check_duplicate_faces(mesh);
  {
    const HalfEdges half_edges(mesh);
    check_edges(half_edges);
    check_fans(mesh, half_edges);
    result.flipped_faces = disagreeing_faces(mesh, half_edges);
  }
  if (!result.flipped_faces.empty() && !options.repair_orientation)
    throw FairingError(
        ErrorCode::inconsistent_orientation,
        listing(face_s, result.flipped_faces, {"looks", "look"}) +
            " the other way than the neighbours. Recalculate the normals, or ask for the repair.",
        result.flipped_faces);
  check_coincident_vertices(mesh, result.warnings);
  check_areas(mesh);
  warn_of_isolated_vertices(mesh, result.warnings);
  return result;
}

}  // namespace fairing
