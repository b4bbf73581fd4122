// SPDX-License-Identifier: GPL-3.0-or-later
#include "fair/recent_surfaces.h"

#include <Eigen/Eigenvalues>
#include <algorithm>

#include "execution/vectors.h"

namespace fairing {
namespace {

constexpr double same_kind = 1e-2;     // what a mixture may leave of a change
constexpr double least_column = 1e-4;  // of the change now: smaller ones would be enlarged with their errors
constexpr double singular = 1e-10;     // an eigenvalue of the normal equations, of columns of length one

double farthest(std::span<const Vec3> a, std::span<const Vec3> b) {
  double most = 0;
  for (std::size_t v = 0; v < a.size(); ++v) most = std::max(most, (a[v] - b[v]).norm());
  return most;
}

}  // namespace

void RecentSurfaces::took(std::span<const Vec3> places) {
  places_.assign(places.begin(), places.end());
  known_ = true;
}

// Least squares over the control vertices.
RecentSurfaces::Shares RecentSurfaces::shares_of(std::span<const Vec3> places) const {
  Eigen::Matrix<double, 7, 7> gram = Eigen::Matrix<double, 7, 7>::Zero();
  Shares right = Shares::Zero();
  double change = 0;
  for (std::size_t v = 0; v < places.size(); ++v) {
    Eigen::Matrix<double, 7, 1> row = Eigen::Matrix<double, 7, 1>::Zero();
    row[0] = 1;
    row.segment<3>(1) = places_[v];
    if (anchored_) row.segment<3>(4) = places_[v] - anchor_places_[v];
    const Vec3 moved = places[v] - places_[v];
    gram += row * row.transpose();
    right += row * moved.transpose();
    change += moved.squaredNorm();
  }
  Eigen::Matrix<double, 7, 1> unit;
  for (int k = 0; k < 7; ++k)
    unit[k] =
        gram(k, k) > least_column * least_column * change && gram(k, k) > 0 ? 1 / std::sqrt(gram(k, k)) : 0;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, 7, 7>> solver(unit.asDiagonal() * gram *
                                                                          unit.asDiagonal());
  Eigen::Matrix<double, 7, 1> inverse;
  for (int k = 0; k < 7; ++k)
    inverse[k] = solver.eigenvalues()[k] > singular ? 1 / solver.eigenvalues()[k] : 0;
  return unit.asDiagonal() *
         (solver.eigenvectors() *
          (inverse.asDiagonal() * (solver.eigenvectors().transpose() * (unit.asDiagonal() * right))));
}

void RecentSurfaces::foresee(std::span<const Vec3> places) {
  const Shares shares = shares_of(places);
  foreseen_.resize(places.size());
  for (std::size_t v = 0; v < places.size(); ++v) {
    Vec3 p = places_[v] + shares.row(0).transpose() + shares.middleRows<3>(1).transpose() * places_[v];
    if (anchored_) p += shares.bottomRows<3>().transpose() * (places_[v] - anchor_places_[v]);
    foreseen_[v] = p;
  }
  const bool another_kind = farthest(foreseen_, places) > same_kind * farthest(places_, places);
  const bool mixes = anchored_;
  if (another_kind) {
    anchor_places_.swap(places_);
    places_ = anchor_places_;
    anchored_ = true;
  }
  if (anchor_.size() != surface_.size()) anchor_.resize(surface_.size());
  workers_.for_parts(surface_.size() / 3, vector_grain / 3, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      Eigen::Map<Vec3> x(surface_.data() + 3 * i), anchor(anchor_.data() + 3 * i);
      const Vec3 last = x;
      Vec3 p = last + shares.row(0).transpose() + shares.middleRows<3>(1).transpose() * last;
      if (mixes) p += shares.bottomRows<3>().transpose() * (last - anchor);
      if (another_kind) anchor = last;
      x = p;
    }
  });
}

}  // namespace fairing
