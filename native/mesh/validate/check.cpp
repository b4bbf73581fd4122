// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/validate/check.h"

#include "mesh/validate/checks.h"

namespace fairing {

bool Defect::mended(ErrorCode what, ElementKind of) {
  switch (what) {
    case ErrorCode::repeated_vertex:
    case ErrorCode::duplicate_face:
    case ErrorCode::degenerate_face:
    case ErrorCode::coincident_vertices:
    case ErrorCode::inconsistent_orientation: return true;
    case ErrorCode::bad_shape:  // too few corners
    case ErrorCode::index_out_of_range: return of == ElementKind::face;
    default: return false;
  }
}

Findings find_defects(const PolygonMesh& mesh, const CheckOptions& options) {
  Findings result;
  Defects& found = result.defects;
  const Readable readable = check_arrays(mesh, found);
  if (!readable.faces) return result;
  check_duplicate_faces(mesh, found);
  if (readable.simple) {
    const HalfEdges half_edges(mesh);
    check_nonmanifold_edges(half_edges, found);
    check_nonmanifold_vertices(mesh, half_edges, found);
    Orientation orientation = find_orientation(mesh, half_edges);
    check_orientation(orientation, options.repair, found);
    result.flipped_faces = std::move(orientation.to_flip);
  }
  if (readable.coordinates) {
    check_coincident_vertices(mesh, found);
    check_areas(mesh, found);
  }
  warn_of_isolated_vertices(mesh, found);
  return result;
}

CheckResult check(const PolygonMesh& mesh, const CheckOptions& options) {
  Findings findings = find_defects(mesh, options);
  CheckResult result;
  for (const Defect& defect : findings.defects) {
    if (defect.severity == Severity::error) defect.raise();
    if (!Defect::turns_faces(defect.code))  // those are reported by flipped_faces
      result.warnings.push_back({name(defect.code), defect.message, defect.elements, defect.kind});
  }
  result.flipped_faces = std::move(findings.flipped_faces);
  return result;
}

}  // namespace fairing
