// SPDX-License-Identifier: GPL-3.0-or-later
#include "fairing/recent_surfaces.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <utility>

#include "base/roundoff.h"
#include "parallel/reductions.h"

namespace fairing {
namespace {

// A change of the same kind is explained by the fit except for this share; otherwise a new kind
// begins, and the last surface becomes the earlier one. Least-squares columns shorter than this
// share of the present change are omitted, since their errors would be amplified.
constexpr double same_kind = 1e-2;

double farthest(std::span<const Vec3> a, std::span<const Vec3> b) {
  double most = 0;
  for (std::size_t v = 0; v < a.size(); ++v) most = std::max(most, (a[v] - b[v]).norm());
  return most;
}

}  // namespace

void RecentSurfaces::remember(Surface surface, std::span<const Vec3> positions) {
  surface_ = std::move(surface);
  positions_.assign(positions.begin(), positions.end());
  known_ = true;
}

RecentSurfaces::Coefficients RecentSurfaces::fit(std::span<const Vec3> positions) const {
  Eigen::Matrix<double, 7, 7> gram = Eigen::Matrix<double, 7, 7>::Zero();
  Coefficients right = Coefficients::Zero();
  double change = 0;
  for (std::size_t v = 0; v < positions.size(); ++v) {
    Eigen::Matrix<double, 7, 1> row = Eigen::Matrix<double, 7, 1>::Zero();
    row[0] = 1;
    row.segment<3>(1) = positions_[v];
    if (has_earlier_) row.segment<3>(4) = positions_[v] - earlier_positions_[v];
    const Vec3 moved = positions[v] - positions_[v];
    gram += row * row.transpose();
    right += row * moved.transpose();
    change += moved.squaredNorm();
  }
  Eigen::Matrix<double, 7, 1> unit;
  for (int k = 0; k < 7; ++k)
    unit[k] = gram(k, k) > same_kind * same_kind * change && gram(k, k) > 0
                  ? 1 / std::sqrt(gram(k, k))
                  : 0;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, 7, 7>> solver(unit.asDiagonal() * gram *
                                                                          unit.asDiagonal());
  Eigen::Matrix<double, 7, 1> inverse;
  // A flat mesh, for example, leaves directions undetermined.
  for (int k = 0; k < 7; ++k)
    inverse[k] = solver.eigenvalues()[k] > roundoff ? 1 / solver.eigenvalues()[k] : 0;
  return unit.asDiagonal() *
         (solver.eigenvectors() * (inverse.asDiagonal() * (solver.eigenvectors().transpose() *
                                                           (unit.asDiagonal() * right))));
}

void RecentSurfaces::extrapolate(std::span<const Vec3> positions) {
  const Coefficients coefficients = fit(positions);
  extrapolated_.resize(positions.size());
  for (std::size_t v = 0; v < positions.size(); ++v) {
    Vec3 p = positions_[v] + coefficients.row(0).transpose() +
             coefficients.middleRows<3>(1).transpose() * positions_[v];
    if (has_earlier_)
      p += coefficients.bottomRows<3>().transpose() * (positions_[v] - earlier_positions_[v]);
    extrapolated_[v] = p;
  }
  const bool another_kind =
      farthest(extrapolated_, positions) > same_kind * farthest(positions_, positions);
  const bool had_earlier = has_earlier_;
  if (another_kind) {
    earlier_positions_.swap(positions_);
    has_earlier_ = true;
  }
  positions_.assign(positions.begin(), positions.end());
  Loads& loads = surface_.state.loads;
  earlier_loads_.resize(loads.size(), Vec3::Zero());
  for (std::size_t v = 0; v < loads.size(); ++v) {
    const Vec3 last = loads[v];
    loads[v] += coefficients.middleRows<3>(1).transpose() * last;
    if (had_earlier)
      loads[v] += coefficients.bottomRows<3>().transpose() * (last - earlier_loads_[v]);
    if (another_kind) earlier_loads_[v] = last;
  }
  Array<double>& plate = surface_.plate;
  earlier_plate_.resize(plate.size());
  workers_.for_each(plate.size() / 3, vector_grain / 3, [&](std::size_t i) {
    Eigen::Map<Vec3> x(plate.data() + 3 * i), earlier(earlier_plate_.data() + 3 * i);
    const Vec3 last = x;
    Vec3 p =
        last + coefficients.row(0).transpose() + coefficients.middleRows<3>(1).transpose() * last;
    if (had_earlier) p += coefficients.bottomRows<3>().transpose() * (last - earlier);
    if (another_kind) earlier = last;
    x = p;
  });
}

}  // namespace fairing
