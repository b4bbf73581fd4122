// SPDX-License-Identifier: GPL-3.0-or-later
#include "fair/unknowns.h"

#include "fair/constrain.h"

namespace fairing {

Unknowns choose_unknowns(const ControlMesh& mesh, const FairOptions& options) {
  Unknowns u;
  u.vertex.assign(std::size_t(mesh.vertex_count()), 0);
  for (Index v = 0; v < mesh.vertex_count(); ++v) {
    const bool on_curve = mesh.feature_vertex[std::size_t(v)] || mesh.ring(v).empty();
    const bool moves = v >= mesh.input_vertices || control_vertex_moves(options, v);
    u.vertex[std::size_t(v)] = moves && !on_curve && mesh.vertex_place(v) == Place::inside;
    u.any_vertex |= bool(u.vertex[std::size_t(v)]);
  }
  u.edge.resize(mesh.edges.size());
  for (std::size_t e = 0; e < mesh.edges.size(); ++e)
    u.edge[e] = !mesh.feature_edge[e] && mesh.edge_place(Index(e)) == Place::inside;
  for (const Place place : mesh.region.face) u.face.push_back(place == Place::inside);
  return u;
}

}  // namespace fairing
