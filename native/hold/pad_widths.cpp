// SPDX-License-Identifier: GPL-3.0-or-later
#include "hold/pad_widths.h"

#include <algorithm>
#include <cmath>

#include "grid/ring.h"
#include "mesh/sheets.h"

namespace fairing {
namespace {

// How much more than on point forces a surface on pads may bend, as factors: a star, in mean stars
// above `crumpled`, since what hardly bends may bend more; all stars, above which the mesh is
// crumpled or all pads are too wide; and a star on a crumpled mesh.
constexpr double slack_of_star = 2, most_of_all = 1.2, most_of_crumpled = 1.1;
constexpr int calm_rounds = 1;     // in which all pads are halved where the mesh is not crumpled
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

// What is judged as one: a sheet where sheets meet, otherwise the whole mesh.
struct Part {
  double sum = 0, of_needles = 0;
  double thrown = 0;  // how much more stars bend that are thrown about
  std::size_t stars = 0;

  bool over() const { return sum > most_of_all * of_needles && sum > flat_energy; }
  // Not for the sake of some stars: all pads are somewhat too wide.
  bool calm() const { return over() && thrown < 0.5 * (sum - of_needles); }
  double slack() const { return slack_of_star * of_needles / double(stars); }
};

std::vector<Index> parts_of(const ControlMesh& mesh) {
  return mesh.copied_vertex.empty() ? std::vector<Index>(std::size_t(mesh.vertex_count()), 0)
                                    : number_sheets(mesh).of_vertex;
}

std::vector<Part> judge(const std::vector<Index>& part_of, const std::vector<double>& energy,
                        const std::vector<double>& of_needles) {
  std::vector<Part> parts(part_of.size());
  for (std::size_t v = 0; v < energy.size(); ++v) {
    Part& part = parts[std::size_t(part_of[v])];
    part.sum += energy[v];
    part.of_needles += of_needles[v];
    ++part.stars;
  }
  for (std::size_t v = 0; v < energy.size(); ++v) {
    Part& part = parts[std::size_t(part_of[v])];
    if (energy[v] > crumpled * of_needles[v] + part.slack())
      part.thrown += energy[v] - of_needles[v];
  }
  return parts;
}

// Beside wide pads a narrow one bends its star more than before: those around it give way once too.
void halve_ring(const GridLevel& control, const Pads& pads, Index v, std::vector<int>& halvings) {
  visit_ring(control, v, [&](Index u, std::size_t) {
    if (pads.is_whole(std::size_t(u)))
      halvings[std::size_t(u)] = std::max(halvings[std::size_t(u)], 1);
  });
}

}  // namespace

std::vector<int> halvings_of_pads(const GridLevel& control, const Pads& pads,
                                  const std::vector<double>& energy,
                                  const std::vector<double>& of_needles, int round) {
  const std::vector<Index> part_of = parts_of(control.mesh());
  const std::vector<Part> parts = judge(part_of, energy, of_needles);
  std::vector<int> halvings(energy.size(), 0);
  for (std::size_t v = 0; v < energy.size(); ++v) {
    const Part& part = parts[std::size_t(part_of[v])];
    if (part.calm()) {
      halvings[v] = round < calm_rounds && pads.under(v) ? 1 : 0;
      continue;
    }
    const bool over = part.over();
    const double most = over ? most_of_crumpled : crumpled, above = over ? 0 : part.slack();
    const double excess = energy[v] / (most * of_needles[v] + above);
    if (!pads.began_under(v) || !(energy[v] > flat_energy) || !(excess > 1)) continue;
    const int times = round >= patient_rounds
                          ? to_nothing
                          : 1 + int(std::log2(std::min(excess, std::ldexp(1.0, to_nothing - 1))));
    for (const Index w : nearest_pads(control, pads, Index(v)))
      halvings[std::size_t(w)] = std::max(halvings[std::size_t(w)], times);
    if (!over) halve_ring(control, pads, Index(v), halvings);
  }
  if (std::none_of(halvings.begin(), halvings.end(), [](int times) { return times > 0; }))
    halvings.clear();
  return halvings;
}

}  // namespace fairing
