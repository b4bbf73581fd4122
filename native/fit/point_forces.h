// SPDX-License-Identifier: GPL-3.0-or-later
// The forces of a scan on a surface: each point acts along the surface's normal at its foot,
// proportional to its distance. Lumped to a weight and a force for each point of a level
// (docs/python/fit.md).
#pragma once

#include "fit/feet.h"
#include "stencil/weights.h"

namespace fairing {

// Robust statistics of residuals, of which the largest may be gross errors.
struct Spread {
  double rms = 0;  // by the median of absolute values, as for a normal distribution
  std::size_t count = 0;
};

// For the offsets of feet that are used, and whose flag in `counts` is set; empty: all.
Spread spread_of(const Array<Foot>& feet, std::span<const std::uint8_t> counts);

// Least spread, in mean control edges: scans without noise leave residuals that the level's edges
// cannot follow, which are not outliers.
constexpr double least_noise = 1.0 / 256;

// An offset of this many times the spread is an outlier and has no force.
constexpr double outlier = 8;

// Weight of a point: 1 near the surface, falling from twice the spread on, 0 for outliers [Huber
// 1964, cut off].
inline double robust_weight(double offset, double rms) {
  const double far = std::abs(offset);
  if (!(far > 2 * rms)) return 1;
  return far > outlier * rms ? 0 : 2 * rms / far;
}

// Sums the forces of a scan's points on the points of a level. Sums go cell by cell, so they are
// the same for any number of threads.
class PointForces {
 public:
  PointForces(const Cells& cells, Workers& workers) : cells_(cells), workers_(workers) {}

  // `robust_weight`: weight of each point of the scan, at least 0. weight <- the sum of the points'
  // weights at each point of the level, force <- the same times offsets along normals.
  void sum(const FeetFinder& finder, const Array<Foot>& feet, const Array<float>& robust_weight,
           VertexWeights& weight, Array<Vec3>& force);

  // Memory that is kept between sums.
  static constexpr std::int64_t bytes_a_cell =
      sizeof(std::array<Eigen::Vector4d, 4>) + sizeof(Index);

 private:
  void sort(const Array<Foot>& feet, const Array<float>& robust_weight);

  const Cells& cells_;
  Workers& workers_;
  Array<Index> begin_, sorted_;                 // the scan's points sorted by cells
  Array<std::array<Eigen::Vector4d, 4>> slot_;  // for the corners of each cell: force and weight
};

// Weights on the level below: those of points that are not on it are divided between the points
// that they lie between.
VertexWeights weights_below(const GridLevel& fine, const GridLevel& coarse,
                            const VertexWeights& weights);

}  // namespace fairing
