// SPDX-License-Identifier: GPL-3.0-or-later
// All feature curves of a control mesh, refined.
#pragma once

#include <span>
#include <vector>

#include "curves/curve.h"
#include "mesh/control_mesh.h"

namespace fairing {

struct FeatureCurves {
  int points_per_edge = 0;  // subdivisions - 1
  // Per edge: the number of its run in `points`; -1: not on a chain. Copies share a run.
  std::vector<Index> run;
  std::vector<Vec3> points;           // run after run, points_per_edge each
  std::vector<Index> straightened{};  // control edges, ascending

  // The interior points of a feature edge, from its vertex[0] to its vertex[1].
  std::span<const Vec3> of(Index edge) const {
    return {points.data() + std::size_t(run[edge]) * std::size_t(points_per_edge),
            std::size_t(points_per_edge)};
  }
};

// Moves the points of these edges' runs onto the edges, for these control vertex positions.
void straighten(const ControlMesh& mesh, std::span<const Index> edges,
                std::span<const Vec3> positions, FeatureCurves& curves);

// Straight chains stay on their edges (point k is at k / scheme.subdivisions, the same from either end,
// bit for bit). All others are refined by refine_chain, and become straight where faces are too
// narrow for them.
//
// Through these positions of the control vertices. The parameters of the chains come from
// `parameters`; if both are the same array, the result is that of a mesh with these positions.
FeatureCurves refine_feature_edges(const ControlMesh& mesh, std::span<const Vec3> parameters,
                                   std::span<const Vec3> positions, const CurveScheme& scheme);

}  // namespace fairing
