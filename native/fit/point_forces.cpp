// SPDX-License-Identifier: GPL-3.0-or-later
#include "fit/point_forces.h"

#include <algorithm>
#include <cmath>

#include "base/median.h"
#include "grid/runs.h"
#include "parallel/reductions.h"

namespace fairing {
Spread spread_of(const Array<Foot>& feet, std::span<const std::uint8_t> counts) {
  Array<float> far;
  far.reserve(feet.size());
  for (std::size_t s = 0; s < feet.size(); ++s)
    if (feet[s].is_used() && (counts.empty() || counts[s])) far.push_back(std::abs(feet[s].offset));
  stop_if_cancelled();
  return {deviation_over_median * median(far), far.size()};
}

void PointForces::sort(const Array<Foot>& feet, const Array<float>& robust_weight) {
  const auto is_used = [&](std::size_t s) { return feet[s].is_used() && robust_weight[s] > 0; };
  begin_.assign(cells_.size() + 1, 0);
  for (std::size_t s = 0; s < feet.size(); ++s)
    if (is_used(s)) ++begin_[std::size_t(feet[s].cell) + 1];
  for (std::size_t c = 0; c < cells_.size(); ++c) begin_[c + 1] += begin_[c];
  sorted_.resize(std::size_t(begin_.back()));
  Array<Index> next(begin_.begin(), begin_.end() - 1);
  for (const std::size_t s : Cancellable(feet.size())) {
    if (is_used(s)) sorted_[next[feet[s].cell]++] = Index(s);
  }
}

void PointForces::sum(const FeetFinder& finder, const Array<Foot>& feet,
                      const Array<float>& robust_weight, VertexWeights& weight,
                      Array<Vec3>& force) {
  sort(feet, robust_weight);
  slot_.resize(cells_.size());
  workers_.for_each(cells_.size(), vertex_grain, [&](std::size_t c) {
    auto& slot = slot_[c];
    slot.fill(Eigen::Vector4d::Zero());
    if (begin_[c] == begin_[c + 1]) return;
    const std::array<Vec3, 4> normals = finder.corner_normals(Index(c));
    for (Index k = begin_[c]; k < begin_[c + 1]; ++k) {
      const auto s = std::size_t(sorted_[k]);
      const Foot& foot = feet[s];
      Eigen::Vector4d force_and_weight;
      force_and_weight << double(foot.offset) * FeetFinder::normal_at(foot, normals), 1;
      for (std::size_t a = 0; a < 4; ++a)
        slot[a] += double(robust_weight[s]) * double(foot.shares[a]) * force_and_weight;
    }
  });
  const std::size_t points = cells_.grid().size();
  weight.resize(points);
  force.resize(points);
  workers_.for_each(points, vertex_grain, [&](std::size_t p) {
    Eigen::Vector4d sum = Eigen::Vector4d::Zero();
    for (const auto& [cell, corner] : cells_.at_point(Index(p))) sum += slot_[cell][corner];
    force[p] = sum.head<3>();
    weight[p] = sum[3];
  });
}

VertexWeights weights_below(const GridLevel& fine, const GridLevel& coarse,
                            const VertexWeights& weights) {
  VertexWeights out(coarse.size(), 0.0);
  const auto add = [&](Index p, double weight) { out[p] += weight; };
  for_each_run(fine, [&](const Run& run) {
    for (std::size_t k = 0; k < run.count; ++k) {
      const double weight = weights[run.first + k];
      if (weight == 0) continue;
      const int i = int(k) + 1, j = run.row;
      const int low = i / 2, high = (i + 1) / 2;
      if (run.kind == RunKind::vertex) {
        add(run.element, weight);
      } else if (run.kind == RunKind::edge) {
        add(coarse.edge_point(run.element, low), weight / 2);
        add(coarse.edge_point(run.element, high), weight / 2);
      } else {
        const int below = j / 2, above = (j + 1) / 2;
        const auto at = [&](int a, int b) { return coarse.face_point(run.element, a, b); };
        if (run.quad) {
          for (const Index p : {at(low, below), at(high, below), at(low, above), at(high, above)})
            add(p, weight / 4);
        } else {  // across the diagonal if both are odd
          add(at(low, above), weight / 2);
          add(at(high, below), weight / 2);
        }
      }
    }
  });
  return out;
}

}  // namespace fairing
