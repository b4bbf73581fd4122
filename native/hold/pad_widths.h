// SPDX-License-Identifier: GPL-3.0-or-later
// Pads that give way under the steps of total curvature. Between folds and on thin fins the loads
// throw the surface about, and its curvature is many times what point forces leave. There a pad is
// narrower than it reaches by itself (pad_reach.h), or gone. A coarse level shows enough.
#pragma once

#include "grid/grid_level.h"
#include "hold/pads.h"

namespace fairing {

// Where widths are chosen: the coarsest level that shows how a pad bends its faces.
constexpr int widths_level = 2;

// A star, or a surface, that bends so many times as much as on point forces is thrown about.
constexpr double crumpled = 2.0;

// An energy that is rounding: a sphere has 8 pi, a plane none.
constexpr double flat_energy = 1e-16;

constexpr int to_nothing = 8;  // halvings, after which a pad is gone

// How often each pad is to be halved; empty: all may stay. `energy` and `of_needles` are the total
// curvatures of the star of each control vertex, of the surface on pads and of that on point
// forces; `round` counts earlier answers. `control` is level 0. All stars are judged before any pad
// changes, so that the order of vertices does not matter. Where sheets meet, each is judged alone.
std::vector<int> halvings_of_pads(const GridLevel& control, const Pads& pads,
                                  const std::vector<double>& energy,
                                  const std::vector<double>& of_needles, int round);

// Halves them. Loads keep the whole force: hats have areas.
template <int N>
void narrow_pads(const std::vector<int>& halvings, Pads& pads, LoadsOf<N>& loads) {
  for (std::size_t v = 0; v < halvings.size(); ++v) {
    if (halvings[v] == 0) continue;
    const double before = pads.shares()[v];
    pads.narrow(v, halvings[v]);
    if (loads.empty()) continue;
    const double ratio = pads.under(v) ? before / pads.shares()[v] : 0.0;
    loads[v] *= ratio * ratio;
  }
}

}  // namespace fairing
