// SPDX-License-Identifier: GPL-3.0-or-later
#include "hold/pad_widths.h"

#include <algorithm>
#include <cmath>

#include "grid/ring.h"

namespace fairing {
namespace {

constexpr int patient_rounds = 4;  // afterwards pads go at once, without halves
constexpr int farthest = 4;        // rings around a star, in which pads may be why it bends

// The nearest control vertices on pads, ring by ring: v itself, or all in the first ring that has
// any. Empty beyond `farthest` rings. `control` is level 0, whose points are the control vertices.
std::vector<Index> nearest_pads(const GridLevel& control, const Pads& pads, Index v) {
  std::vector<Index> ring{v}, seen{v}, found;
  for (int distance = 0; distance <= farthest; ++distance) {
    for (const Index w : ring)
      if (pads.under(std::size_t(w))) found.push_back(w);
    if (!found.empty()) break;
    std::vector<Index> next;
    for (const Index w : ring)
      visit_ring(control, w, [&](Index u, std::size_t) {
        if (std::find(seen.begin(), seen.end(), u) != seen.end()) return;
        seen.push_back(u);
        next.push_back(u);
      });
    ring = std::move(next);
  }
  return found;
}

}  // namespace

std::vector<int> halvings_of_pads(const GridLevel& control, const Pads& pads,
                                  const PadLimits& limits, const std::vector<double>& energy,
                                  const std::vector<double>& of_needles, int round) {
  double sum = 0, sum_of_needles = 0;
  for (const double e : energy) sum += e;
  for (const double e : of_needles) sum_of_needles += e;
  const double mean_slack = limits.slack * sum_of_needles / double(of_needles.size());
  const bool over = sum > limits.whole * sum_of_needles;
  bool is_crumpled = false;
  for (std::size_t v = 0; v < energy.size(); ++v)
    is_crumpled |= energy[v] > crumpled * of_needles[v] + mean_slack;
  if (over && !is_crumpled) {
    // Nothing is thrown about: all pads are somewhat too wide.
    std::vector<int> all(round < limits.calm_rounds ? energy.size() : 0);
    for (std::size_t v = 0; v < all.size(); ++v) all[v] = pads.under(v) ? 1 : 0;
    return all;
  }
  const double most = over ? limits.strict : limits.star, above = over ? 0 : mean_slack;
  std::vector<int> halvings(energy.size(), 0);
  for (std::size_t v = 0; v < energy.size(); ++v) {
    const double excess = energy[v] / (most * of_needles[v] + above);
    if (!pads.began_under(v) || !(excess > 1)) continue;
    const int times = round >= patient_rounds
                          ? to_nothing
                          : 1 + int(std::log2(std::min(excess, std::ldexp(1.0, to_nothing - 1))));
    for (const Index w : nearest_pads(control, pads, Index(v)))
      halvings[std::size_t(w)] = std::max(halvings[std::size_t(w)], times);
  }
  if (std::none_of(halvings.begin(), halvings.end(), [](int times) { return times > 0; }))
    halvings.clear();
  return halvings;
}

}  // namespace fairing
