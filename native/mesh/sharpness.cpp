// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/sharpness.h"

#include <cmath>
#include <string>

#include "base/error.h"

namespace fairing {

const char* up_to(double most) { return std::isfinite(most) ? "from 0 to 1" : "zero or positive"; }

void check_edge_values(const std::string& name, std::int64_t vertices, const EdgeValues& given,
                       double most) {
  const auto refuse = [](const std::string& message, std::vector<std::int64_t> elements = {}) {
    throw FairingError(ErrorCode::bad_option, message, std::move(elements), ElementKind::vertex);
  };
  const auto& [pairs, values] = given;
  if (pairs.size() != values.size())
    refuse(name + " has " + std::to_string(values.size()) + " values for " +
           std::to_string(pairs.size()) + " edges; give one for each edge.");
  std::vector<std::int64_t> unknown, bad;
  for (std::size_t k = 0; k < pairs.size(); ++k)
    for (const std::int64_t v : pairs[k]) {
      if (v < 0 || v >= vertices) unknown.push_back(v);
      if (!(values[k] >= 0 && values[k] <= most)) bad.push_back(v);
    }
  if (!unknown.empty())
    throw FairingError(ErrorCode::index_out_of_range,
                       "{vertex} {is|are} named by " + name +
                           " but not in the mesh: ids run from 0 to " +
                           std::to_string(vertices - 1) + ".",
                       unknown, ElementKind::vertex);
  if (bad.empty()) return;
  refuse(name + " must be " + up_to(most) + "; see the edge of the vertices " +
             std::to_string(bad[0]) + " and " + std::to_string(bad[1]) + ".",
         bad);
}

VertexRule rule_of(const AroundVertex& around, int steps) {
  if (after(around.vertex, steps) > 0) return VertexRule::corner;
  const auto sharp = std::count_if(around.spokes.begin(), around.spokes.end(),
                                   [&](double spoke) { return after(spoke, steps) > 0; });
  return sharp < 2 ? VertexRule::smooth : sharp == 2 ? VertexRule::crease : VertexRule::corner;
}

double share_of_sharper(const AroundVertex& around, int steps) {
  double sum = 0;
  int count = 0;
  const auto add = [&](double sharpness) {
    const double now = after(sharpness, steps);
    if (!(now > 0 && now <= 1)) return;
    sum += now;
    ++count;
  };
  add(around.vertex);
  for (const double spoke : around.spokes) add(spoke);
  return count ? sum / count : 0;
}

namespace {

double forever(double sharpness) { return sharpness >= always_sharp ? sharp_for_ever : sharpness; }

}  // namespace

SharpRules::SharpRules(const ControlMesh& control, std::span<const std::int64_t> corners,
                       const Sharpness& given)
    : vertex_(std::size_t(control.input_vertices), 0.0) {
  const auto& [pairs, values] = given.edges;
  for (std::size_t k = 0; k < pairs.size(); ++k)
    if (values[k] > 0) edges_.emplace_back(ascending(pairs[k][0], pairs[k][1]), forever(values[k]));
  for (Index e = 0; e < control.first_copied_edge(); ++e) {
    if (!control.feature_edge[e] || control.inside_polygon(e)) continue;
    const auto [a, b] = control.edges[e].vertex;
    edges_.emplace_back(ascending(control.original_vertex(a), control.original_vertex(b)),
                        sharp_for_ever);
  }
  std::stable_sort(edges_.begin(), edges_.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });

  std::vector<int> ends(vertex_.size(), 0);
  for (const Chain& chain : control.features()) {
    if (!chain.closed) ++ends[chain.vertices.front()];
    if (!chain.closed) ++ends[chain.vertices.back()];
    if (chain.straight)
      for (const Index v : chain.vertices) vertex_[v] = sharp_for_ever;
  }
  for (std::size_t v = 0; v < vertex_.size(); ++v)
    if (ends[v] == 2) vertex_[v] = sharp_for_ever;  // one curve in two parts: it turns sharply
  for (const std::int64_t v : corners) vertex_[v] = sharp_for_ever;
  for (std::size_t v = 0; v < given.vertices.size(); ++v)
    if (given.vertices[v] > 0) vertex_[v] = forever(given.vertices[v]);
}

double SharpRules::edge(std::int64_t a, std::int64_t b) const {
  const auto pair = ascending(a, b);
  const auto at =
      std::lower_bound(edges_.begin(), edges_.end(), pair,
                       [](const auto& sharp, const auto& wanted) { return sharp.first < wanted; });
  return at == edges_.end() || at->first != pair ? 0 : at->second;
}

}  // namespace fairing
