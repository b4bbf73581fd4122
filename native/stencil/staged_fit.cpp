// SPDX-License-Identifier: GPL-3.0-or-later
// In a file of its own, since decompositions of dynamic size take the longest of all to compile,
// and half of that is parsing Eigen's templates.
#include "stencil/staged_fit.h"

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

}  // namespace

FitRows staged_fit(std::span<const Vec2> ring, int leading) {
  double radius = 0;
  for (const Vec2& p : ring) radius += p.norm() / double(ring.size());
  if (!(radius > 0)) return FitRows::Zero(5, Eigen::Index(ring.size()));
  Columns a(ring.size(), 5);
  for (std::size_t j = 0; j < ring.size(); ++j)
    a.row(Eigen::Index(j)) = basis(ring[j] / radius).transpose();
  const Columns first = a.leftCols(leading), second = a.rightCols(5 - leading);
  const Columns first_inverse = pseudo_inverse(first);
  const Columns rest = second - first * (first_inverse * second);
  // `rest` is compared with `second`: if it is zero, its own largest singular value is noise. All
  // columns together, since rotations of the chart mix them.
  const Columns second_rows = pseudo_inverse(rest, second.norm());
  FitRows rows(5, a.rows());
  rows.bottomRows(5 - leading) = second_rows;
  rows.topRows(leading) = first_inverse - first_inverse * second * second_rows;
  rows.topRows(2) /= radius;
  rows.bottomRows(3) /= radius * radius;
  return rows;
}

}  // namespace fairing
