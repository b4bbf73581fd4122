// SPDX-License-Identifier: GPL-3.0-or-later
#include "fairing/unknowns.h"

#include <cmath>
#include <string>

#include "base/error.h"
#include "parallel/cancel.h"

namespace fairing {
namespace {

// Whether control vertex v is an unknown of the solve. A vertex where sheets touch is fixed, since
// each sheet would move it differently.
bool control_vertex_moves(const ControlMesh& mesh, const FairOptions& options, Index v) {
  if (v >= mesh.first_centre()) return true;
  if (mesh.fans_meet(v)) return false;
  const auto original = std::size_t(mesh.original_vertex(v));
  return options.tolerance_of(original) > 0 &&
         (options.weights.empty() || std::isfinite(options.weights[original]));
}

}  // namespace

Unknowns choose_unknowns(const ControlMesh& mesh, const FairOptions& options) {
  Unknowns u;
  u.vertex.assign(std::size_t(mesh.vertex_count()), 0);
  for (const Index v : Cancellable(mesh.vertex_count())) {
    const bool on_curve = mesh.feature_vertex[v] || mesh.ring(v).empty();
    const bool moves = control_vertex_moves(mesh, options, v);
    u.vertex[v] = moves && !on_curve && mesh.vertex_part(v) == RegionPart::inside;
    u.any_vertex |= bool(u.vertex[v]);
  }
  u.edge.resize(mesh.edges.size());
  for (std::size_t e = 0; e < mesh.edges.size(); ++e)
    u.edge[e] = !mesh.feature_edge[e] && mesh.edge_part(Index(e)) == RegionPart::inside;
  for (const RegionPart part : mesh.region.face) u.face.push_back(part == RegionPart::inside);
  return u;
}

void require_anchored(const ControlMesh& mesh, const Unknowns& unknowns,
                      const VertexWeights& weights) {
  const auto anchored = [&](std::size_t v) {
    return !unknowns.vertex[v] || (!weights.empty() && weights[v] > 0);
  };
  // All vertices that are connected to anchors by edges are held.
  std::vector<std::uint8_t> held(std::size_t(mesh.vertex_count()), 0);
  std::vector<Index> front;
  for (std::size_t v = 0; v < held.size(); ++v)
    if (anchored(v)) {
      held[v] = 1;
      front.push_back(Index(v));
    }
  for (std::size_t step = 0; !front.empty(); ++step) {
    stop_if_cancelled(step);
    const Index v = front.back();
    front.pop_back();
    for (const Spoke& spoke : mesh.ring(v)) {
      const Index other = mesh.end_of(spoke);
      if (held[other]) continue;
      held[other] = 1;
      front.push_back(other);
    }
  }
  std::vector<std::int64_t> loose;
  for (std::size_t v = 0; v < std::size_t(mesh.input_vertices); ++v)
    if (!held[v]) loose.push_back(std::int64_t(v));
  if (!loose.empty())
    throw FairingError(
        ErrorCode::underdetermined,
        {"Nothing holds the part of the mesh around vertex " + std::to_string(loose[0]) + ".",
         "Give a vertex of it a weight, or interpolate one."},
        loose);
}

}  // namespace fairing
