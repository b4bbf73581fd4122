// SPDX-License-Identifier: GPL-3.0-or-later
#include "fit/held_out.h"

#include <algorithm>
#include <numbers>

#include "base/mixed.h"
#include "fit/point_tree.h"
#include "parallel/reductions.h"

namespace fairing {
namespace {

// Leaves out points without a foot.
void add_test(const LevelFit& fit, std::size_t point, HeldOut& out) {
  const Foot& foot = fit.feet()[point];
  if (foot.is_used()) out.tests.push_back({point, foot, fit.finder().normal_at(foot)});
}

// As wide as a scanner's noise is correlated to both sides: five cells and eleven points across, so
// that noise over five points does not reach the middle of a disc; but no wider than a control edge.
double radius_of_disc(const LevelFit& fit) {
  const double widest = 5 * std::sqrt(points_a_blob / std::numbers::pi) * fit.apart();
  return std::min(widest, fit.edge() / 2);
}

// The places of a scan's points on the surface. (In space, points near one another have noise that
// is alike, if it is as large as points are apart.)
Array<Vec3> places_of(const LevelFit& fit) {
  Array<Vec3> out = fit.scan().point;
  for_each_index(fit.workers(), out.size(), [&](std::size_t s) {
    const Foot& foot = fit.feet()[s];
    if (foot.cell >= 0) out[s] = fit.finder().point_at_foot(foot);
  });
  return out;
}

// Holds out all points within the radius of a centre; those within half of it are tests.
HeldOut around(const LevelFit& fit, const Array<Vec3>& place,
               const std::vector<std::size_t>& centres, double radius) {
  HeldOut out;
  out.trained.assign(place.size(), 1);
  if (centres.empty()) return out;
  std::vector<Vec3> centre;
  for (const std::size_t s : centres) centre.push_back(place[s]);
  const PointsOfTree of_tree{centre.data()->data(), centre.size()};
  const PointTree tree(3, of_tree);
  Array<double> square(place.size());  // of the distance from the nearest centre
  for_each_index(fit.workers(), place.size(), [&](std::size_t s) {
    Index which = -1;
    nanoflann::KNNResultSet<double, Index> nearest(1);
    nearest.init(&which, &square[s]);
    tree.findNeighbors(nearest, place[s].data(), {});
  });
  for (std::size_t s = 0; s < place.size(); ++s) {
    if (square[s] <= radius * radius) out.trained[s] = 0;
    if (4 * square[s] <= radius * radius) add_test(fit, s, out);
  }
  return out;
}

// A result of nanoflann: visits all points within a distance.
template <class Visit>
struct AllWithin {
  using DistanceType = double;
  using IndexType = Index;
  const Visit& visit;
  double square;
  bool addPoint(double far, Index p) {
    visit(far, p);
    return true;
  }
  double worstDist() const { return square; }
  std::size_t size() const { return 1; }
  bool full() const { return true; }
  void sort() {}
};

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
  }
  return out;
}

std::vector<HeldOut> discs_held_out(const LevelFit& fit) {
  const double radius = radius_of_disc(fit), across = radius / fit.apart();
  std::vector<std::vector<std::size_t>> centres(4);  // for tests are on a quarter of each disc
  const auto every =
      std::uint64_t(double(centres.size()) * std::max(std::numbers::pi * across * across, 1.0));
  for (std::size_t s = 0; s < fit.scan().size(); ++s)
    if (const std::uint64_t set = mixed(s) % every; set < centres.size()) centres[set].push_back(s);
  const Array<Vec3> place = places_of(fit);
  std::vector<HeldOut> out;
  for (const auto& set : centres) out.push_back(around(fit, place, set, radius));
  return out;
}

double shared_noise(const LevelFit& fit, const HeldOut& held) {
  const double square = std::pow(radius_of_disc(fit), 2), most = 2 * fit.spread().rms;
  const Array<Vec3> place = places_of(fit);
  const PointsOfTree of_tree{place.data()->data(), place.size()};
  const PointTree tree(3, of_tree);
  const auto offset = [&](std::size_t s) {
    return std::clamp(double(fit.feet()[s].offset), -most, most);
  };
  double sum = 0, count = 0;
  for (const auto& test : held.tests) {
    const std::size_t s = test.point;
    if (!fit.feet()[s].is_used()) continue;
    const Vec3 normal = fit.finder().normal_at(fit.feet()[s]);
    double alike = 0;
    const auto visit = [&](double far, Index p) {
      const Foot& other = fit.feet()[p];
      if (std::size_t(p) == s || !other.is_used() || normal.dot(fit.finder().normal_at(other)) < 0)
        return;
      alike += far < square ? offset(p) : -offset(p);
    };
    AllWithin<decltype(visit)> within{visit, 2 * square};
    tree.findNeighbors(within, place[s].data(), {});
    sum += offset(s) * alike;
    count += 1;
  }
  stop_if_cancelled();
  return count > 0 ? std::max(sum / count, 0.0) : 0;
}

}  // namespace fairing
