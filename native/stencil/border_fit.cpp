// SPDX-License-Identifier: GPL-3.0-or-later
#include "stencil/border_fit.h"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <Eigen/QR>
#include <cmath>

namespace fairing {
namespace {

constexpr int curvatures = 5;  // terms up to second degree

// x, y, x²/2, x y, y²/2, then those of third and higher degree.
void terms(double x, double y, int degree,
           Eigen::Ref<Eigen::RowVectorXd, 0, Eigen::InnerStride<>> out) {
  out.head<curvatures>() << x, y, x * x / 2, x * y, y * y / 2;
  Eigen::Index at = curvatures;
  for (int of = 3; of <= degree; ++of)
    for (int k = 0; k <= of; ++k) {
      double term = 1;
      for (int i = 0; i < of; ++i) term *= i < k ? y : x;
      out[at++] = term;
    }
}

// (n, 5): the first rows of the pseudoinverse of (n, t), as columns. Borders of two or three faces
// have no full rank.
Eigen::MatrixXd first_rows(const Eigen::MatrixXd& matrix, double full_rank) {
  const Eigen::Index t = matrix.cols();
  Eigen::MatrixXd normal = Eigen::MatrixXd::Zero(t, t);
  normal.selfadjointView<Eigen::Lower>().rankUpdate(matrix.transpose());
  const Eigen::LLT<Eigen::MatrixXd> factor(normal);
  const Eigen::ArrayXd least = full_rank * normal.diagonal().array().sqrt();
  if (factor.info() == Eigen::Success && (factor.matrixLLT().diagonal().array() > least).all())
    return matrix * factor.solve(Eigen::MatrixXd::Identity(t, curvatures));
  const Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> full(matrix);
  return full.pseudoInverse().topRows(curvatures).transpose();
}

}  // namespace

BorderFit fit_border(std::span<const Vec3> away, Vec3 along, Vec3 up,
                     const BorderFitOptions& options) {
  const auto n = Eigen::Index(away.size());
  const Eigen::Map<const Eigen::Matrix3Xd> points(away.data()->data(), 3, n);
  const double size = std::sqrt(points.colwise().squaredNorm().maxCoeff());
  Eigen::MatrixXd matrix(n, (options.degree + 1) * (options.degree + 2) / 2 - 1), inverse;
  Eigen::Matrix<double, 1, curvatures> solved;
  for (int round = 0; round < 3; ++round) {
    up = (up - up.dot(along) * along).normalized();
    const Vec3 inward = up.cross(along);
    const Eigen::VectorXd x = points.transpose() * along / size;
    const Eigen::VectorXd y = points.transpose() * inward / size;
    const Eigen::VectorXd z = points.transpose() * up / size;
    const Eigen::ArrayXd weight =
        (options.soft + x.array().square() + y.array().square()).inverse();
    for (Eigen::Index k = 0; k < n; ++k) {
      terms(x[k], y[k], options.degree, matrix.row(k));
      matrix.row(k) *= weight[k];
    }
    inverse = first_rows(matrix, options.full_rank);
    inverse.array().colwise() *= weight;
    solved = z.transpose() * inverse;
    along = (along + solved[0] * up).normalized();
    up -= solved[0] * along + solved[1] * inward;
    if (solved.head<2>().cwiseAbs().maxCoeff() < options.level) break;
  }
  up = (up - up.dot(along) * along).normalized();
  Eigen::Matrix<double, 3, 2> axes;
  axes << along, up.cross(along);
  Eigen::Matrix2d bend;
  bend << solved[2], solved[3], solved[3], solved[4];
  Eigen::MatrixX2d rows(n, 2);
  rows << inverse.col(1) / size, inverse.col(4) / (size * size);
  return {up, axes.col(1), axes * (bend / size) * axes.transpose(), rows};
}

}  // namespace fairing
