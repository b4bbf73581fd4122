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

std::vector<Flatness> flatness(const ControlMesh& control) {
  std::vector<FacePlane> planes;
  for (const Face& face : control.faces) planes.push_back(plane_of(face, control.positions));
  const auto vertices = std::size_t(control.vertex_count());
  std::vector<std::uint8_t> flat(vertices), inside(vertices), paired(vertices);
  for (std::size_t v = 0; v < vertices; ++v) {
    const auto ring = control.ring(Index(v));
    flat[v] = std::all_of(ring.begin(), ring.end(), [&](const Spoke& spoke) {
      return spoke.face < 0 || in_one_plane(planes[ring[0].face], planes[spoke.face]);
    });
    inside[v] = flat[v] && Index(v) < control.first_centre() &&
                std::none_of(ring.begin(), ring.end(), [](const Spoke& s) { return s.face < 0; });
  }
  for (const Edge& edge : control.edges) {
    const auto [a, b] = edge.vertex;
    if (inside[a] && inside[b]) paired[a] = paired[b] = 1;
  }
  std::vector<Flatness> out;
  for (const Face& face : control.faces) {
    const auto corners = std::span(face.vertex).first(std::size_t(face.size));
    const bool amid = std::all_of(corners.begin(), corners.end(), [&](Index v) { return flat[v]; });
    const bool beside =
        std::any_of(corners.begin(), corners.end(), [&](Index v) { return paired[v]; });
    out.push_back(amid ? Flatness::amid : beside ? Flatness::beside : Flatness::none);
  }
  return out;
}

}  // namespace fairing
