// SPDX-License-Identifier: GPL-3.0-or-later
#include "fit/round_off.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "grid/turns.h"

namespace fairing {
namespace {

// Each takes two iterations; the last ones change little.
constexpr int most_passes = 9;

// More is a fold: neither a surface nor a control mesh of finer ones.
constexpr double sharpest = std::numbers::pi / 2;

// Makes the shares of faces that turn by more smaller, as a plate is stiffer against the shorter wave.
// Where a face's own points hardly act any more, those around it make the bend.
void lessen(const ControlMesh& mesh, const std::vector<double>& turn, std::vector<double>& share) {
  const auto factor = [&](std::size_t f) {
    return std::pow(sharpest / std::max(turn[f], sharpest), 4);
  };
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
  std::vector<double> share(grid.mesh().faces.size(), 1.0);
  for (int pass = 0; pass < most_passes; ++pass) {
    const std::vector<double> turn = sharpest_turns(grid, fit.workers(), fit.surface().data());
    if (*std::max_element(turn.begin(), turn.end()) <= sharpest) return;
    lessen(grid.mesh(), turn, share);
    fit.set_shares(share);
    fit.iterate(weight, 2, true);
  }
}

}  // namespace fairing
