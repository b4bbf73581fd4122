// SPDX-License-Identifier: GPL-3.0-or-later
// What a scan does to a surface: each of its points pulls along the surface's normal at its foot, by how
// far it is off. Lumped on the points of a level: a weight and a force each (docs/python/fit.md).
#pragma once

#include "fit/feet.h"
#include "stencil/weights.h"

namespace fairing {

// Numbers by which residuals are judged whose largest may be gross errors.
struct Spread {
  double rms = 0;  // what a bell curve with the same median of absolute values has
  std::size_t count = 0;
};

// Of the offsets of feet that pull, where `counts` says so, one flag a point; empty: all.
Spread spread_of(const Array<Foot>& feet, std::span<const std::uint8_t> counts);

// A bell curve's deviation over the median of its absolute values.
constexpr double of_median = 1.4826022185056018;

// The least spread, in mean control edges, that points are judged by: scans without noise leave what the
// level's edges cannot follow, which is no stray.
constexpr double least_noise = 1.0 / 256;

// Beyond so many times the spread an offset is an error of measurement, and pulls no more.
constexpr double stray = 8;

// What of a point's pull counts: 1 near the surface, falling from twice the spread on, 0 for strays
// [Huber 1964, cut off].
inline double trust(double offset, double rms) {
  const double far = std::abs(offset);
  if (!(far > 2 * rms)) return 1;
  return far > stray * rms ? 0 : 2 * rms / far;
}

// The pulls of a scan's points, summed up on a level's. Sums go cell by cell, and so are the same for any
// number of threads.
class PullSums {
 public:
  PullSums(const Cells& cells, Workers& workers) : cells_(cells), workers_(workers) {}

  // `trust`: of each point of the scan, 0 or more. weight <- the shares of points that pull at each point of the
  // level, force <- these times offsets along normals.
  void sum(const FeetFinder& finder, const Array<Foot>& feet, const Array<float>& trust,
           VertexWeights& weight, Array<Vec3>& force);

  // Of what is kept between sums.
  static constexpr std::int64_t bytes_a_cell =
      sizeof(std::array<Eigen::Vector4d, 4>) + sizeof(Index);

 private:
  void sort(const Array<Foot>& feet, const Array<float>& trust);

  const Cells& cells_;
  Workers& workers_;
  Array<Index> begin_, sorted_;                 // the scan's points by cells
  Array<std::array<Eigen::Vector4d, 4>> slot_;  // of each cell's corners: force and weight
};

// Weights of a level on the level below: those of points that are not there, shared among the points that
// they lie between.
VertexWeights weights_below(const GridLevel& fine, const GridLevel& coarse,
                            const VertexWeights& weights);

}  // namespace fairing
