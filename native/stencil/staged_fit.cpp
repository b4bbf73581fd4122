// SPDX-License-Identifier: GPL-3.0-or-later
// In a file of its own: decompositions of general size take longest to compile of all the core, and
// half of that is reading Eigen's templates.
#include "stencil/staged_fit.h"

#include <Eigen/Eigenvalues>
#include <Eigen/SVD>
#include <algorithm>
#include <memory>
#include <new>

namespace fairing {
namespace {

using Columns = Eigen::MatrixXd;

// Below these no largest value counts: the matrix is zero.
constexpr double least_singular_value = 1e-12, least_eigenvalue = 1e-300;

// So many rows and columns need no memory but the stack.
constexpr int most_on_stack = 16;
using FewColumns =
    Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, most_on_stack, most_on_stack>;

// Without the undetermined directions.
template <class Matrix>
Columns pseudo_inverse_of(const Matrix& a) {
  auto svd = std::make_unique<Eigen::JacobiSVD<Matrix>>();
  try {
    svd->compute(a, Eigen::ComputeThinU | Eigen::ComputeThinV);
  } catch (const std::bad_alloc&) {
    static_cast<void>(svd.release());  // it would free once more what it has found no memory for
    throw;
  }
  const auto& sigma = svd->singularValues();
  const double least =
      undetermined * (sigma.size() ? std::max(sigma(0), least_singular_value) : 0.0);
  Columns middle = svd->matrixU().adjoint();
  for (Eigen::Index k = 0; k < sigma.size(); ++k)
    middle.row(k) *= sigma(k) > least ? 1 / sigma(k) : 0.0;
  const Columns left = svd->matrixV();
  return left * middle;
}

Columns pseudo_inverse(const Columns& a) {
  return std::max(a.rows(), a.cols()) <= most_on_stack ? pseudo_inverse_of(FewColumns(a))
                                                       : pseudo_inverse_of(a);
}

// Of a positive semidefinite matrix, by its eigenvectors.
template <int Size>
Eigen::Matrix<double, Size, Size> gram_pseudo_inverse(
    const Eigen::Matrix<double, Size, Size>& gram) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, Size, Size>> eigen(gram);
  Eigen::Matrix<double, Size, 1> inverse = eigen.eigenvalues();
  const double least = std::max(undetermined_square * inverse(Size - 1), least_eigenvalue);
  for (int k = 0; k < Size; ++k) inverse(k) = inverse(k) > least ? 1 / inverse(k) : 0.0;
  return eigen.eigenvectors() * inverse.asDiagonal() * eigen.eigenvectors().transpose();
}

}  // namespace

FitRows staged_fit(const Columns& a, int leading) {
  const Columns first = a.leftCols(leading), second = a.rightCols(5 - leading);
  const Columns first_inverse = pseudo_inverse(first);
  const Columns rest = second - first * (first_inverse * second);
  // `rest` is compared with `second`: where nothing is left, its own largest singular value is
  // noise.
  Columns guarded = rest;
  for (Eigen::Index c = 0; c < guarded.cols(); ++c)
    if (guarded.col(c).norm() < undetermined * second.norm()) guarded.col(c).setZero();
  const Columns second_rows = pseudo_inverse(guarded);
  FitRows rows(5, a.rows());
  rows.bottomRows(5 - leading) = second_rows;
  rows.topRows(leading) = first_inverse - first_inverse * second * second_rows;
  return rows;
}

Vec3 staged_hessian(std::span<const Vec2> ring, std::span<const double> f) {
  double radius = 0;
  for (const Vec2& p : ring) radius += p.norm() / double(ring.size());
  if (!(radius > 0)) return Vec3::Zero();
  Eigen::Matrix<double, 5, 5> gram = Eigen::Matrix<double, 5, 5>::Zero();
  Coefficients moment = Coefficients::Zero();
  for (std::size_t j = 0; j < ring.size(); ++j) {
    const Coefficients b = basis(ring[j] / radius);
    gram += b * b.transpose();
    moment += f[j] * b;
  }
  const Eigen::Matrix3d first = gram_pseudo_inverse<3>(gram.topLeftCorner<3, 3>());
  const Eigen::Matrix<double, 3, 2> mixed = first * gram.topRightCorner<3, 2>();
  Eigen::Matrix2d left = gram.bottomRightCorner<2, 2>() - gram.bottomLeftCorner<2, 3>() * mixed;
  const double whole = gram.bottomRightCorner<2, 2>().trace();
  for (int k = 0; k < 2; ++k)
    if (left(k, k) < undetermined_square * whole) {
      left.row(k).setZero();
      left.col(k).setZero();
    }
  Eigen::Vector2d rest = moment.tail<2>() - mixed.transpose() * moment.head<3>();
  for (int k = 0; k < 2; ++k)
    if (left(k, k) == 0) rest(k) = 0;
  const Eigen::Vector2d free = gram_pseudo_inverse<2>(left) * rest;
  const Vec3 leading = first * moment.head<3>() - mixed * free;
  return Vec3(leading(2), free(0), free(1)) / (radius * radius);
}

}  // namespace fairing
