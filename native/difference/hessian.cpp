// SPDX-License-Identifier: GPL-3.0-or-later
#include "difference/hessian.h"

#include <Eigen/Eigenvalues>
#include <cmath>
#include <numbers>

namespace fairing {
namespace {

Vec3 orthonormal(double uu, double uv, double vv) {
  constexpr double root_half = std::numbers::sqrt2 / 2;
  return {root_half * (uu + vv), root_half * (uu - vv), std::numbers::sqrt2 * uv};
}

// Least squares after the ring has been made round (x, y have unit covariance and no correlation): the linear
// terms then drop out of the normal equations by division, and a 3 x 3 system is left.
class RoundFit {
 public:
  // False when undetermined. No weights: all are one.
  bool make(std::span<const Vec2> ring, std::span<const double> weight) {
    double uu = 0, uv = 0, vv = 0;
    for (std::size_t j = 0; j < ring.size(); ++j) {
      const Vec2 &p = ring[j], q = weight.empty() ? p : Vec2(weight[j] * p);
      uu += q.x() * p.x();
      uv += q.x() * p.y();
      vv += q.y() * p.y();
    }
    if (!(uu > 0)) return false;
    const double rest = vv - uv * uv / uu, n = double(ring.size());
    if (!(rest > 1e-24 * uu)) return false;
    w0 = std::sqrt(n / uu), w2 = std::sqrt(n / rest), w1 = -w2 * uv / uu;
    each = 1 / n;

    double aa = 0, ab = 0, ac = 0, bb = 0, bc = 0, cc = 0;
    xa = ya = xb = yb = xc = yc = 0;
    for (std::size_t j = 0; j < ring.size(); ++j) {
      const Term t = term(ring[j]);
      const Term q = weight.empty() ? t : t.times(weight[j]);
      aa += q.a * t.a, ab += q.a * t.b, ac += q.a * t.c, bb += q.b * t.b, bc += q.b * t.c, cc += q.c * t.c;
      xa += q.x * t.a, ya += q.y * t.a, xb += q.x * t.b, yb += q.y * t.b, xc += q.x * t.c, yc += q.y * t.c;
    }
    s00 = without_linear(aa, xa, ya, xa, ya);
    const double s01 = without_linear(ab, xa, ya, xb, yb), s11 = without_linear(bb, xb, yb, xb, yb),
                 s12 = without_linear(bc, xb, yb, xc, yc), s22 = without_linear(cc, xc, yc, xc, yc);
    s02 = without_linear(ac, xa, ya, xc, yc);
    if (!(s00 > undetermined_square * aa)) return false;
    l10 = s01 / s00, l20 = s02 / s00, d1 = s11 - l10 * s01;
    const double t12 = s12 - l10 * s02;
    if (!(d1 > undetermined_square * bb)) return false;
    l21 = t12 / d1, d2 = s22 - l20 * s02 - l21 * t12;
    return d2 > undetermined_square * cc;
  }

  Vec3 hessian(std::span<const Vec2> ring, std::span<const double> weight, std::span<const double> f) const {
    double fx = 0, fy = 0, fa = 0, fb = 0, fc = 0;
    for (std::size_t j = 0; j < ring.size(); ++j) {
      const Term t = term(ring[j]);
      const double g = weight.empty() ? f[j] : weight[j] * f[j];
      fx += g * t.x, fy += g * t.y, fa += g * t.a, fb += g * t.b, fc += g * t.c;
    }
    return solve(fx, fy, fa, fb, fc);
  }

  // What a unit difference at p alone contributes.
  Vec3 row(const Vec2& p, double weight) const {
    const Term t = term(p).times(weight);
    return solve(t.x, t.y, t.a, t.b, t.c);
  }

 private:
  struct Term {
    double x, y, a, b, c;  // a = x^2 + y^2, b = x^2 - y^2, c = 2 x y
    Term times(double w) const { return {w * x, w * y, w * a, w * b, w * c}; }
  };
  Term term(const Vec2& p) const {
    const double x = w0 * p.x(), y = w1 * p.x() + w2 * p.y(), xx = x * x, yy = y * y;
    return {x, y, xx + yy, xx - yy, 2 * x * y};
  }
  double without_linear(double whole, double x, double y, double other_x, double other_y) const {
    return whole - each * (x * other_x + y * other_y);
  }
  Vec3 solve(double fx, double fy, double fa, double fb, double fc) const {
    const double r0 = without_linear(fa, fx, fy, xa, ya), r1 = without_linear(fb, fx, fy, xb, yb),
                 r2 = without_linear(fc, fx, fy, xc, yc);
    const double z1 = r1 - l10 * r0, c2 = (r2 - l20 * r0 - l21 * z1) / d2, c1 = z1 / d1 - l21 * c2,
                 c0 = r0 / s00 - l10 * c1 - l20 * c2;
    const double f_xx = 2 * (c0 + c1), f_yy = 2 * (c0 - c1), f_xy = 2 * c2;
    return orthonormal(w0 * w0 * f_xx + 2 * w0 * w1 * f_xy + w1 * w1 * f_yy, w2 * (w0 * f_xy + w1 * f_yy),
                       w2 * w2 * f_yy);
  }

  double w0, w1, w2, each;
  double xa, ya, xb, yb, xc, yc;
  double s00, s02, l10, l20, l21, d1, d2;
};

template <int Size>
Eigen::Matrix<double, Size, Size> pseudo_inverse(const Eigen::Matrix<double, Size, Size>& gram) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, Size, Size>> eigen(gram);
  Eigen::Matrix<double, Size, 1> inverse = eigen.eigenvalues();
  const double least = std::max(undetermined_square * inverse(Size - 1), 1e-300);
  for (int k = 0; k < Size; ++k) inverse(k) = inverse(k) > least ? 1 / inverse(k) : 0.0;
  return eigen.eigenvectors() * inverse.asDiagonal() * eigen.eigenvectors().transpose();
}

// fit()'s two stages as normal equations: gradient and trace first, then what is left by least norm.
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
  const Eigen::Matrix3d first = pseudo_inverse<3>(gram.topLeftCorner<3, 3>());
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
  const Eigen::Vector2d free = pseudo_inverse<2>(left) * rest;
  const Vec3 leading = first * moment.head<3>() - mixed * free;
  return Vec3(leading(2), free(0), free(1)) / (radius * radius);
}

}  // namespace

Vec3 fitted_hessian(std::span<const Vec2> ring, std::span<const double> difference,
                    std::span<const double> weight) {
  RoundFit round;
  if (ring.size() >= 5 && round.make(ring, weight)) return round.hessian(ring, weight, difference);
  return staged_hessian(ring, difference);
}

void hessian_rows(std::span<const Vec2> ring, std::span<const double> weight, std::vector<Vec3>& rows) {
  rows.resize(ring.size());
  RoundFit round;
  if (ring.size() >= 5 && round.make(ring, weight)) {
    for (std::size_t j = 0; j < ring.size(); ++j)
      rows[j] = round.row(ring[j], weight.empty() ? 1.0 : weight[j]);
    return;
  }
  std::vector<double> unit(ring.size(), 0.0);
  for (std::size_t j = 0; j < ring.size(); ++j) {
    unit[j] = 1;
    rows[j] = staged_hessian(ring, unit);
    unit[j] = 0;
  }
}

}  // namespace fairing
