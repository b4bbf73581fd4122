// SPDX-License-Identifier: GPL-3.0-or-later
#include "curvature/local_damping.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "curvature/steps.h"
#include "parallel/reductions.h"
#include "stencil/fit.h"

namespace fairing {
namespace {

// mu at the first failure of a prediction, which is also the least mu of filled points (measured:
// without damping they may fold again, with mu = 1 they hardly move); the factors by which mu grows
// after a failure and falls after a success.
constexpr float first = 0.05f, growth = 8, decay = 0.25f;
// Squared difference from the prediction, relative to the sum of both squares and the mean density.
// Above `failed` (half of that after each rejected step) the prediction has failed, below `held` it
// was right. In between mu stays.
constexpr double failed = 0.15, held = 0.02;
// After this number of accepted steps mu grows by `insistence` a step where predictions have failed
// twice, until it may fall; otherwise the steps might not end.
constexpr int patience = 5;
constexpr float insistence = 3;  // times, each step

Eigen::Matrix3d tensor(const float* m, const Linearization& surface, std::size_t point) {
  const Vec3 u = Eigen::Map<const Eigen::Vector3f>(surface.axis.data() + 3 * point).cast<double>();
  const Vec3 v = Eigen::Map<const Vec3>(surface.normal.data() + 3 * point).cross(u);
  const Eigen::Matrix3d uu = u * u.transpose(), vv = v * v.transpose(), uv = u * v.transpose();
  return root_half * (double(m[0]) * (uu + vv) + double(m[1]) * (uu - vv) +
                      double(m[2]) * (uv + uv.transpose()));
}

}  // namespace

void dilate(const GridLevel& grid, Workers& workers, ElementSlots<float, 1>& slots,
            const Unknowns* unknowns, Array<float>& marks) {
  Array<float> out(marks.size());
  accumulate_runs(
      grid, workers, slots, unknowns, out.data(), [] { return std::vector<Index>(); },
      [&](const Run& run, float* const* target, std::vector<Index>& ring) {
        const float* mark = marks.data() + run.first;
        for (std::size_t i = 0; i < run.count; ++i) {
          if (!(mark[i] > 0)) continue;
          ring.clear();
          append_ring(grid, run, i, ring);
          for (std::size_t s = 0; s <= ring.size(); ++s) target[s][i] += 1;
        }
      });
  marks.swap(out);
}

LocalDamping::LocalDamping(const GridLevel& grid, const Unknowns& unknowns, Workers& workers)
    : grid_(grid), unknowns_(unknowns), workers_(workers) {}

void LocalDamping::start() {
  if (!mu_.empty()) return;
  mu_.assign(grid_.size(), 0.0f);
  failures_.assign(grid_.size(), 0);
}

void LocalDamping::hold(const Array<float>& marks) {
  start();
  if (least_.empty()) least_.assign(grid_.size(), 0.0f);
  for_each_index(workers_, marks.size(), [&](std::size_t i) {
    if (!(marks[i] > 0)) return;
    least_[i] = first;
    mu_[i] = std::max(mu_[i], first);
  });
  any_ = true;
}

bool LocalDamping::judge(const Array<float>& predicted, const Linearization& before,
                         const Linearization& after, int rejections, int steps, double decrement) {
  const std::size_t points = grid_.size();
  const double whole =
      sum(workers_, points, [&](std::size_t i) { return area_of(&before.shape[4 * i]); });
  const double energy = sum(workers_, points, [&](std::size_t i) {
    return area_of(&before.shape[4 * i]) * square_of(&before.shape[4 * i]);
  });
  const double mean = whole > 0 ? energy / whole : 0;
  Array<float> miss(points), marks(points);
  const double bound = failed * std::pow(0.5, rejections);
  for_each_index(workers_, points, [&](std::size_t i) {
    const float *m = &before.shape[4 * i], *now = &after.shape[4 * i];
    // Charts start at an arbitrary neighbour, so tensors are compared in space.
    const Eigen::Matrix3d change = tensor(now, after, i) - tensor(&predicted[3 * i], before, i);
    const double scale = square_of(m) + square_of(now) + mean;
    miss[i] = m[3] > 0 && now[3] > 0 && scale > 0 ? float(change.squaredNorm() / scale)
                                                  : (m[3] > 0 ? 1.0f : 0.0f);
    marks[i] = double(miss[i]) > bound ? 1.0f : 0.0f;
  });
  dilate(grid_, workers_, slots_, &unknowns_, marks);
  start();
  for_each_index(workers_, points, [&](std::size_t i) {
    float& mu = mu_[i];
    if (marks[i] > 0) {
      mu = std::max(growth * mu, first);
      failures_[i] = std::uint8_t(std::min(failures_[i] + 1, 100));
      return;
    }
    // Near the end damping would only slow the last steps.
    const bool released =
        double(miss[i]) < held && (failures_[i] < 2 || decrement < damped_decrement);
    if (released)
      mu = decay * mu < first / 8 ? 0.0f : decay * mu;
    else if (steps >= patience && failures_[i] >= 2)
      mu *= insistence;
  });
  if (!least_.empty())
    for_each_index(workers_, points, [&](std::size_t i) { mu_[i] = std::max(mu_[i], least_[i]); });
  const bool before_any = any_;
  any_ = sum(workers_, points, [&](std::size_t i) { return mu_[i] > 0 ? 1.0 : 0.0; }) > 0;
  return any_ || before_any;
}

}  // namespace fairing
