// SPDX-License-Identifier: GPL-3.0-or-later
// In a file of its own, since decompositions of dynamic size take the longest of all to compile,
// and half of that is parsing Eigen's templates.
#include "stencil/staged_fit.h"

#include <Eigen/Eigenvalues>
#include <Eigen/SVD>
#include <algorithm>
#include <memory>
#include <new>

namespace fairing {
namespace {

using Columns = Eigen::MatrixXd;

// Up to this number of rows and columns the stack is used.
constexpr int most_on_stack = 16;
using FewColumns =
    Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, most_on_stack, most_on_stack>;

constexpr int thin = Eigen::ComputeThinU | Eigen::ComputeThinV;
#if EIGEN_MAJOR_VERSION >= 5  // has a 4 in version 3.4
template <class Matrix>
using ThinSvd = Eigen::JacobiSVD<Matrix, thin>;
template <class Matrix>
void decompose(const Matrix& a, ThinSvd<Matrix>& svd) {
  svd.compute(a);
}
#else
template <class Matrix>
using ThinSvd = Eigen::JacobiSVD<Matrix>;
template <class Matrix>
void decompose(const Matrix& a, ThinSvd<Matrix>& svd) {
  svd.compute(a, thin);
}
#endif

// Omits directions with singular values below a share of the largest, or of `scale` if larger.
template <class Matrix>
Columns pseudo_inverse_of(const Matrix& a, double scale) {
  auto svd = std::make_unique<ThinSvd<Matrix>>();
  try {
    decompose(a, *svd);
  } catch (const std::bad_alloc&) {
    // its destructor would free memory that it failed to allocate
    static_cast<void>(svd.release());
    throw;
  }
  const auto& sigma = svd->singularValues();
  const double least = undetermined * std::max(sigma.size() ? sigma(0) : 0.0, scale);
  Columns middle = svd->matrixU().adjoint();
  for (Eigen::Index k = 0; k < sigma.size(); ++k)
    middle.row(k) *= sigma(k) > least ? 1 / sigma(k) : 0.0;
  const Columns left = svd->matrixV();
  return left * middle;
}

Columns pseudo_inverse(const Columns& a, double scale = 0) {
  return std::max(a.rows(), a.cols()) <= most_on_stack ? pseudo_inverse_of(FewColumns(a), scale)
                                                       : pseudo_inverse_of(a, scale);
}

// The same for a positive semidefinite matrix, by its eigenvectors.
template <int Size>
Eigen::Matrix<double, Size, Size> gram_pseudo_inverse(const Eigen::Matrix<double, Size, Size>& gram,
                                                      double scale = 0) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, Size, Size>> eigen(gram);
  Eigen::Matrix<double, Size, 1> inverse = eigen.eigenvalues();
  const double least = undetermined_square * std::max({inverse(Size - 1), scale, 0.0});
  for (int k = 0; k < Size; ++k) inverse(k) = inverse(k) > least ? 1 / inverse(k) : 0.0;
  return eigen.eigenvectors() * inverse.asDiagonal() * eigen.eigenvectors().transpose();
}

}  // namespace

FitRows staged_fit(const Columns& a, int leading) {
  const Columns first = a.leftCols(leading), second = a.rightCols(5 - leading);
  const Columns first_inverse = pseudo_inverse(first);
  const Columns rest = second - first * (first_inverse * second);
  // `rest` is compared with `second`: if it is zero, its own largest singular value is noise. All
  // columns together, since rotations of the chart mix them.
  const Columns second_rows = pseudo_inverse(rest, second.norm());
  FitRows rows(5, a.rows());
  rows.bottomRows(5 - leading) = second_rows;
  rows.topRows(leading) = first_inverse - first_inverse * second * second_rows;
  return rows;
}

StagedHessian::StagedHessian(std::span<const Vec2> ring) : ring_(ring) {
  for (const Vec2& p : ring) radius_ += p.norm() / double(ring.size());
  if (!(radius_ > 0)) return;
  Eigen::Matrix<double, 5, 5> gram = Eigen::Matrix<double, 5, 5>::Zero();
  for (std::size_t j = 0; j < ring.size(); ++j) {
    const Coefficients b = basis_at(j);
    gram += b * b.transpose();
  }
  first_ = gram_pseudo_inverse<3>(gram.topLeftCorner<3, 3>());
  mixed_ = first_ * gram.topRightCorner<3, 2>();
  const Eigen::Matrix2d left =
      gram.bottomRightCorner<2, 2>() - gram.bottomLeftCorner<2, 3>() * mixed_;
  left_inverse_ = gram_pseudo_inverse<2>(left, gram.bottomRightCorner<2, 2>().trace());
}

Coefficients StagedHessian::basis_at(std::size_t j) const { return basis(ring_[j] / radius_); }

Vec3 StagedHessian::operator()(std::span<const double> difference) const {
  if (!(radius_ > 0)) return Vec3::Zero();
  Coefficients moment = Coefficients::Zero();
  for (std::size_t j = 0; j < ring_.size(); ++j) moment += difference[j] * basis_at(j);
  return solve(moment);
}

Vec3 StagedHessian::of_neighbour(std::size_t j) const {
  return radius_ > 0 ? solve(basis_at(j)) : Vec3(Vec3::Zero());
}

Vec3 StagedHessian::solve(const Coefficients& moment) const {
  const Eigen::Vector2d rest = moment.tail<2>() - mixed_.transpose() * moment.head<3>();
  const Eigen::Vector2d free = left_inverse_ * rest;
  const Vec3 leading = first_ * moment.head<3>() - mixed_ * free;
  return Vec3(leading(2), free(0), free(1)) / (radius_ * radius_);
}

}  // namespace fairing
