// SPDX-License-Identifier: GPL-3.0-or-later
#include "splines/kept.h"

#include <algorithm>

namespace fairing {

Kept kept_from(const Lattice& lattice, const Topology& before, const Topology& topology) {
  Kept out;
  out.curves.assign(std::size_t(topology.curves(lattice)), -1);
  out.patches.assign(topology.patches.size(), -1);
  if (before.chains.empty()) return out;
  const std::size_t chains = topology.chains.size();
  for (std::size_t c = 0; c < chains; ++c) {
    const Index old = before.places[topology.chains[c].edges[0]].chain;
    if (old >= 0 && before.chains[old] == topology.chains[c]) out.curves[c] = old;
  }
  for (std::size_t k = 0; chains + k < out.curves.size(); ++k)
    if (out.curves[topology.chain_of({Index(k / 3), int(k % 3)})] >= 0)
      out.curves[chains + k] = Index(before.chains.size() + k);
  std::vector<std::array<Index, 3>> patch_of(std::size_t(lattice.faces()), {-1, -1, -1});
  const auto old_patch = [&](const PatchPlace& place) -> Index& {
    return patch_of[place.grid.faces[0].face][std::max(0, place.corner)];
  };
  for (std::size_t p = 0; p < before.patches.size(); ++p) old_patch(before.patches[p]) = Index(p);
  for (std::size_t p = 0; p < out.patches.size(); ++p) {
    const PatchPlace& own = topology.patches[p];
    const Index old = old_patch(own);
    if (old >= 0 && before.patches[old].grid == own.grid &&
        std::ranges::all_of(own.side,
                            [&](const PatchSide& side) { return out.curves[side.curve] >= 0; }))
      out.patches[p] = old;
  }
  return out;
}

}  // namespace fairing
