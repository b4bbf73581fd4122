// SPDX-License-Identifier: GPL-3.0-or-later
#include "strain/own_loads.h"

#include "strain/probes.h"

namespace fairing {
namespace {

// Between two vertices of one solve: a dozen solves on quads.
constexpr int rings_apart = 6;

}  // namespace

std::vector<double> own_loads(ThinPlateSolver& solver, const FeatureCurves& curves) {
  const ControlMesh& mesh = solver.levels().shared().mesh;
  std::vector<double> own(std::size_t(mesh.vertex_count()), 0.0);
  if (!solver.pads()) return own;
  const std::vector<std::vector<Index>> sets = vertices_apart(mesh, *solver.pads(), rings_apart);
  probe_loads(solver, curves, sets, {}, [&](std::size_t set, const std::vector<double>& loads) {
    for (const Index v : sets[set]) own[std::size_t(v)] = loads[std::size_t(v)];
  });
  return own;
}

}  // namespace fairing
