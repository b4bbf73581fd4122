// SPDX-License-Identifier: GPL-3.0-or-later
#include "control_mesh/control_mesh.h"

#include <algorithm>

#include "control_mesh/connect.h"
#include "control_mesh/features.h"
#include "control_mesh/region.h"
#include "control_mesh/split.h"
#include "execution/cancel.h"

namespace fairing {
namespace {

std::vector<std::int64_t> oriented_corners(const PolygonMesh& mesh, std::span<const std::int64_t> flipped) {
  std::vector<std::int64_t> corners(mesh.corners.begin(), mesh.corners.end());
  for (std::int64_t f : flipped)  // the first corner stays the first
    std::reverse(corners.begin() + mesh.offsets[std::size_t(f)] + 1,
                 corners.begin() + mesh.offsets[std::size_t(f) + 1]);
  return corners;
}

void take_faces(const SplitMesh& split, ControlMesh& control) {
  Index sides = 0;
  control.faces.reserve(split.faces.size());
  for (const SplitFace& face : split.faces) {
    stop_if_cancelled(control.faces.size());
    const auto size = std::int8_t(face.vertex[3] < 0 ? 3 : 4);
    control.faces.push_back({face.vertex, sides, face.polygon, size});
    sides += size;
  }
  control.sides.reserve(std::size_t(sides));
}

// Where edges and sides are in the rings of their vertices.
void index_spokes(ControlMesh& control) {
  control.spoke_of_edge.resize(2 * control.edges.size());
  control.spoke_of_side.resize(control.sides.size());
  for (std::size_t k = 0; k < control.spokes.size(); ++k) {
    stop_if_cancelled(k);
    const Spoke& spoke = control.spokes[k];
    control.spoke_of_edge[2 * std::size_t(spoke.edge) + (spoke.outward ? 0 : 1)] = Index(k);
    if (spoke.face < 0) continue;
    const Face& face = control.faces[std::size_t(spoke.face)];
    control.spoke_of_side[std::size_t(face.first_side + spoke.corner)] = Index(k);
  }
}

}  // namespace

ControlMesh make_control_mesh(const PolygonMesh& mesh, const FeatureOptions& features,
                              std::span<const std::int64_t> flipped) {
  const std::vector<std::int64_t> corners = oriented_corners(mesh, flipped);
  const PolygonMesh oriented{mesh.coordinates, corners, mesh.offsets};
  const SplitMesh split = split_polygons(oriented);

  ControlMesh control;
  control.input_vertices = Index(mesh.vertex_count());
  control.input_faces = Index(mesh.face_count());
  for (std::size_t v = 0; v < std::size_t(mesh.vertex_count()); ++v)
    control.positions.emplace_back(mesh.coordinates[3 * v], mesh.coordinates[3 * v + 1],
                                   mesh.coordinates[3 * v + 2]);
  control.positions.insert(control.positions.end(), split.centres.begin(), split.centres.end());
  take_faces(split, control);
  connect_faces(control);
  index_spokes(control);
  find_region(features.region, control);
  find_features(oriented, features, control);
  mark_clamped_joint(control);
  return control;
}

}  // namespace fairing
