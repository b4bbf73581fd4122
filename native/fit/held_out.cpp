// SPDX-License-Identifier: GPL-3.0-or-later
#include "fit/held_out.h"

#include <algorithm>
#include <limits>
#include <numbers>

#include "parallel/cancel.h"
#include "parallel/reductions.h"

namespace fairing {
namespace {

// A well mixed number [splitmix64].
std::uint64_t mixed(std::uint64_t number) {
  number += 0x9e3779b97f4a7c15u;
  number = (number ^ (number >> 30)) * 0xbf58476d1ce4e5b9u;
  number = (number ^ (number >> 27)) * 0x94d049bb133111ebu;
  return number ^ (number >> 31);
}

// Leaves out points without a foot.
void add_test(const LevelFit& fit, std::size_t point, HeldOut& out) {
  const Foot& foot = fit.feet()[point];
  if (foot.is_used()) out.tests.push_back({point, foot, fit.finder().normal_at(foot), out.groups});
}

// Holds out all points within the radius of a centre; those within half of it are tests.
HeldOut around(const LevelFit& fit, const std::vector<std::size_t>& centres, double radius) {
  const Array<Vec3>& point = fit.scan().point;
  HeldOut out;
  out.trained.assign(point.size(), 1);
  Array<Index> middle(point.size());  // the centre of the disc in whose middle a point is, or -1
  for_each_index(fit.workers(), point.size(), [&](std::size_t s) {
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t c = 0; c < centres.size(); ++c)
      if (const double square = (point[s] - point[centres[c]]).squaredNorm(); square < least) {
        least = square;
        middle[s] = Index(c);
      }
    if (least <= radius * radius) out.trained[s] = 0;
    if (!(4 * least <= radius * radius)) middle[s] = -1;
  });
  stop_if_cancelled();
  std::vector<std::vector<std::size_t>> points(centres.size());
  for (std::size_t s = 0; s < point.size(); ++s)
    if (middle[s] >= 0) points[std::size_t(middle[s])].push_back(s);
  for (const auto& of : points) {
    const std::size_t before = out.tests.size();
    for (const std::size_t s : of) add_test(fit, s, out);
    if (out.tests.size() > before) ++out.groups;
  }
  return out;
}

}  // namespace

std::size_t HeldOut::trained_points() const {
  return std::size_t(std::count(trained.begin(), trained.end(), 1));
}

// Wider groups, of half a control edge, favour weights three times too large under white noise.
HeldOut cells_held_out(const LevelFit& fit) {
  const GridLevel& grid = fit.cells().grid();
  const auto faces = double(grid.mesh().faces.size());
  int level = fit.level();
  while (level > 1 && double(fit.feet().size()) < points_a_blob * faces * std::pow(4.0, level))
    --level;
  const GridLevel coarse(grid.mesh(), level);
  Workers workers(1);
  const Cells blobs(coarse, workers);
  HeldOut out;
  out.trained.assign(fit.feet().size(), 1);
  for (std::size_t s = 0; s < out.trained.size(); ++s) {
    const Foot& foot = fit.feet()[s];
    if (foot.cell < 0) continue;
    const FacePlace place = fit.cells().place(foot.cell, foot.shares);
    if (mixed(std::uint64_t(blobs.cell_at(place, fit.level()).cell)) % 10 != 0) continue;
    out.trained[s] = 0;
    add_test(fit, s, out);
    out.groups = Index(out.tests.size());
  }
  return out;
}

std::vector<HeldOut> discs_held_out(const LevelFit& fit) {
  // five cells and eleven points across, so that noise over five points does not reach the middles
  const double widest = 5 * std::sqrt(points_a_blob / std::numbers::pi) * fit.apart();
  const double radius = std::min(widest, fit.edge() / 2), across = radius / fit.apart();
  std::vector<std::vector<std::size_t>> centres(4);  // for tests are on a quarter of each disc
  const auto every =
      std::uint64_t(double(centres.size()) * std::max(std::numbers::pi * across * across, 1.0));
  for (std::size_t s = 0; s < fit.scan().size(); ++s)
    if (const std::uint64_t set = mixed(s) % every; set < centres.size()) centres[set].push_back(s);
  std::vector<HeldOut> out;
  for (const auto& set : centres) out.push_back(around(fit, set, radius));
  return out;
}

}  // namespace fairing
