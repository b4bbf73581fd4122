// SPDX-License-Identifier: GPL-3.0-or-later
#include "chart/chart.h"

#include "chart/blend.h"

namespace fairing {

ChartMaker::ChartMaker(const ControlMesh& mesh, const ChartOptions& options)
    : mesh_(mesh),
      options_(options),
      flat_(flatten(mesh, options.kind == ChartKind::tangent ? 1.0 : options.exponent)) {
  if (options.blend != 1.0) uniform_ = flatten(mesh, 0.0);
}

Chart ChartMaker::vertex(Index v) const {
  Chart chart = options_.kind == ChartKind::tangent ? tangent_vertex(v) : exponential_vertex(v, flat_);
  if (!uniform_.empty()) blend(exponential_vertex(v, uniform_), options_.blend, chart);
  return chart;
}

Chart ChartMaker::edge(Index e) const {
  Chart chart = options_.kind == ChartKind::tangent ? tangent_edge(e) : exponential_edge(e, flat_);
  if (!uniform_.empty()) blend(exponential_edge(e, uniform_), options_.blend, chart);
  return chart;
}

Chart ChartMaker::face(Index f) const {
  Chart chart = options_.kind == ChartKind::tangent ? tangent_face(f) : exponential_face(f, flat_);
  if (!uniform_.empty()) blend(exponential_face(f, uniform_), options_.blend, chart);
  return chart;
}

}  // namespace fairing
