// SPDX-License-Identifier: GPL-3.0-or-later
#include "fair/anchored.h"

#include "check/error.h"
#include "execution/cancel.h"

namespace fairing {

void require_anchored(const ControlMesh& mesh, const Unknowns& unknowns, const VertexWeights& weights) {
  const auto anchored = [&](std::size_t v) {
    return !unknowns.vertex[v] || (!weights.empty() && weights[v] > 0);
  };
  // Whatever anchors reach along edges is held.
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
      const Index other = mesh.edges[std::size_t(spoke.edge)].vertex[spoke.outward ? 1 : 0];
      if (held[std::size_t(other)]) continue;
      held[std::size_t(other)] = 1;
      front.push_back(other);
    }
  }
  std::vector<std::int64_t> loose;
  for (std::size_t v = 0; v < std::size_t(mesh.input_vertices); ++v)
    if (!held[v]) loose.push_back(std::int64_t(v));
  if (!loose.empty())
    throw FairingError(ErrorCode::underdetermined,
                       "Nothing holds the part of the mesh around vertex " + std::to_string(loose[0]) +
                           ": give a vertex of it a weight, or interpolate one.",
                       loose);
}

}  // namespace fairing
