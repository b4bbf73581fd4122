// SPDX-License-Identifier: GPL-3.0-or-later
#include "fit/round_off.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "grid/turns.h"

namespace fairing {
namespace {

// A surface bends about no radius shorter than a control edge divided by this.
constexpr double bends_an_edge = 10;
// Each takes two iterations; the last ones change little.
constexpr int most_passes = 9;

// Makes the shares of faces that turn by more than the limit smaller, as a plate is stiffer against
// the shorter wave. Where a face's own points hardly act any more, those around it make the bend.
void lessen(const ControlMesh& mesh, const std::vector<double>& turn, double limit,
            std::vector<double>& share) {
  const auto factor = [&](std::size_t f) { return std::pow(limit / std::max(turn[f], limit), 4); };
  std::vector<double> around(std::size_t(mesh.vertex_count()), 1.0);
  const auto for_vertices = [&](std::size_t f, auto&& visit) {
    const Face& face = mesh.faces[f];
    for (int k = 0; k < face.size; ++k) visit(around[face.vertex[k]]);
  };
  const auto hardly_acts = [&](std::size_t f) { return share[f] < 0.125; };
  for (std::size_t f = 0; f < share.size(); ++f)
    if (hardly_acts(f)) for_vertices(f, [&](double& at) { at = std::min(at, factor(f)); });
  for (std::size_t f = 0; f < share.size(); ++f) {
    double own = factor(f);
    for_vertices(f, [&](double at) { own = std::min(own, at); });
    share[f] *= own;
  }
}

}  // namespace

void round_off(LevelFit& fit, double weight) {
  const GridLevel& grid = fit.cells().grid();
  const double limit = std::min(std::numbers::pi / 2, bends_an_edge / grid.n());
  std::vector<double> share(grid.mesh().faces.size(), 1.0);
  for (int pass = 0; pass < most_passes; ++pass) {
    const std::vector<double> turn = sharpest_turns(grid, fit.workers(), fit.surface().data());
    if (*std::max_element(turn.begin(), turn.end()) <= limit) return;
    lessen(grid.mesh(), turn, limit, share);
    fit.set_shares(share);
    fit.iterate(weight, 2, true);
  }
}

}  // namespace fairing
