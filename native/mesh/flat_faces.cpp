// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/flat_faces.h"

#include <algorithm>

#include "mesh/opposite.h"
#include "mesh/region.h"

namespace fairing {

void mark_flat_faces(std::span<const std::int64_t> faces, ControlMesh& control) {
  if (faces.empty()) return;
  const auto chosen = flags_of_faces(faces, control.input_faces, "flat_faces");
  FlatFaces& flat = control.flat;
  for (const Face& face : control.faces) flat.face.push_back(chosen[std::size_t(face.polygon)]);
  for (const Edge& edge : control.edges)
    flat.edge.push_back(std::all_of(edge.side.begin(), edge.side.end(), [&](Index s) {
      return s < 0 || flat.face[std::size_t(control.sides[std::size_t(s)].face)];
    }));
  for (Index v = 0; v < control.vertex_count(); ++v) {
    const auto ring = control.ring(v);
    flat.vertex.push_back(!ring.empty() &&
                          std::all_of(ring.begin(), ring.end(), [&](const Spoke& spoke) {
                            return spoke.face < 0 || flat.face[std::size_t(spoke.face)];
                          }));
  }
}

std::vector<std::uint8_t> faces_amid_flats(const ControlMesh& control) {
  std::vector<FacePlane> planes;
  for (const Face& face : control.faces) planes.push_back(plane_of(face, control.positions));
  std::vector<std::uint8_t> flags(control.faces.size(), 1);
  for (Index v = 0; v < control.vertex_count(); ++v) {
    const auto ring = control.ring(v);
    const bool is_flat = std::all_of(ring.begin(), ring.end(), [&](const Spoke& spoke) {
      return spoke.face < 0 || in_one_plane(planes[ring[0].face], planes[spoke.face]);
    });
    for (const Spoke& spoke : ring)
      if (spoke.face >= 0 && !is_flat) flags[spoke.face] = 0;
  }
  return flags;
}

}  // namespace fairing
