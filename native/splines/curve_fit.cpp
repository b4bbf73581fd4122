// SPDX-License-Identifier: GPL-3.0-or-later
#include "splines/curve_fit.h"

#include <Eigen/Dense>
#include <Eigen/Sparse>
#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/points.h"
#include "base/roundoff.h"
#include "splines/lattice.h"

namespace fairing {
namespace {

// Weights of distances along the curve, and of those across the lattice's line within the surface.
// A tangent's angle to the surface's tangent plane has their product.
constexpr double slide = 0.1, aside = 0.2;
constexpr int refits = 3;  // each after the points have moved to their feet
// Curvature has a pole at control vertices, which most energies interpolate. Spans near both ends
// are shorter by this share, to follow it.
constexpr double end_share = 0.35;
// Least speed at a narrow corner, relative to the mean speed.
constexpr double slowest = 0.3;

double length_of(const std::vector<Vec3>& points) {
  double length = 0;
  for (std::size_t k = 1; k < points.size(); ++k) length += (points[k] - points[k - 1]).norm();
  return length;
}

// Weights of distances from point k. A smooth curve must lie on the surface; its place in the
// surface is almost free.
Eigen::Matrix3d off_surface(const CurveData& data, std::size_t k) {
  const Eigen::Matrix3d all = Eigen::Matrix3d::Identity();
  if (data.strict || data.normals.empty() || data.normals[k].isZero() || data.is_cut(k)) return all;
  const Vec3& n = data.normals[k];
  return aside * all + (1 - aside) * n * n.transpose();
}

class CurveSystem {
 public:
  CurveSystem(const CurveData& data, int spans) : data_(data), spans_(spans) {
    const int count = control_points(spans);
    fixed_ = Eigen::VectorXd::Zero(3 * count);
    const auto normal = [&](int i) -> Vec3 {  // of the plane that contains a control point
      if (data.normals.empty() || (i != 1 && i + 2 != count)) return Vec3::Zero();
      return i == 1 ? data.normals.front() : data.normals.back();
    };
    Entries entries;
    Eigen::Index column = 0;
    set_fixed(0, data.points.front());
    set_fixed(count - 1, data.points.back());
    for (int i = 1; i + 1 < count; ++i) {
      Eigen::Matrix<double, 3, Eigen::Dynamic> ways = Eigen::Matrix3d::Identity();
      if (const Vec3 n = normal(i); !n.isZero()) {
        ways = tangents_of(n);
        set_fixed(i, i == 1 ? data.points.front() : data.points.back());
      }
      for (Eigen::Index k = 0; k < ways.cols(); ++k, ++column)
        for (int d = 0; d < 3; ++d) entries.emplace_back(3 * i + d, column, ways(d, k));
    }
    basis_.resize(3 * count, column);
    basis_.setFromTriplets(entries.begin(), entries.end());
  }

  // `along`: the tangents at the points; empty: all directions have the same weight.
  SplineCurve solve(const std::vector<double>& t, const std::vector<Vec3>& along) const {
    const bool tilted = !along.empty() && !data_.normals.empty();
    const Eigen::Index height = tilted ? 4 : 3;
    Rows rows{{}, Eigen::VectorXd::Zero(height * Eigen::Index(t.size()))};
    for (std::size_t k = 0; k < t.size(); ++k) {
      const Eigen::Index row = height * Eigen::Index(k);
      const CubicBasis b = cubic_basis(spans_, t[k]);
      Eigen::Matrix3d weight = Eigen::Matrix3d::Identity();
      if (!along.empty())
        weight = off_surface(data_, k) * (weight - (1 - slide) * along[k] * along[k].transpose());
      rows.add(row, b.first, b.value, weight);
      if (tilted) rows.add(row + 3, b.first, b.slope, slide * aside * data_.normals[k].transpose());
      rows.target.segment<3>(row) = weight * data_.points[k];
    }
    Matrix sums;
    Eigen::VectorXd load;
    reduce(rows, sums, load);
    Matrix normal = sums.transpose() * sums;
    const double least = std::numeric_limits<double>::epsilon() * normal.diagonal().maxCoeff();
    for (Eigen::Index k = 0; k < normal.rows(); ++k) normal.coeffRef(k, k) += least;
    const Eigen::SimplicialLDLT<Matrix> factors(normal);
    Eigen::VectorXd free = factors.solve(sums.transpose() * load);
    if (!data_.cuts.empty()) hold_cuts(factors, free);
    const Eigen::VectorXd all = fixed_ + basis_ * free;
    SplineCurve out{spans_, {}};
    for (Eigen::Index i = 0; i < all.size(); i += 3) out.points.push_back(all.segment<3>(i));
    return out;
  }

 private:
  using Matrix = Eigen::SparseMatrix<double>;
  using Entries = std::vector<Eigen::Triplet<double>>;

  struct Rows {
    Entries entries;
    Eigen::VectorXd target;

    template <class Weight>
    void add(Eigen::Index row, int first, const std::array<double, 4>& factors,
             const Weight& weight) {
      for (std::size_t i = 0; i < 4; ++i)
        for (Eigen::Index a = 0; a < weight.rows(); ++a)
          for (Eigen::Index d = 0; d < 3; ++d)
            entries.emplace_back(row + a, 3 * (first + int(i)) + d, factors[i] * weight(a, d));
    }
  };

  void set_fixed(int i, const Vec3& at) { fixed_.segment<3>(3 * i) = at; }

  // Reduces rows to the free control points.
  void reduce(const Rows& rows, Matrix& out, Eigen::VectorXd& target) const {
    Matrix all(rows.target.size(), fixed_.size());
    all.setFromTriplets(rows.entries.begin(), rows.entries.end());
    target = rows.target - all * fixed_;
    out = all * basis_;
  }

  // Interpolates the cuts exactly, with their tangents or the surface's tangent planes, by Lagrange
  // multipliers.
  void hold_cuts(const Eigen::SimplicialLDLT<Matrix>& factors, Eigen::VectorXd& free) const {
    Rows rows;
    rows.target = Eigen::VectorXd::Zero(5 * Eigen::Index(data_.cuts.size()));
    Eigen::Index row = 0;
    for (const CurveData::Cut& cut : data_.cuts) {
      const CubicBasis b = cubic_basis(spans_, cut.t);
      if (cut.t > 0 && cut.t < 1) {
        rows.add(row, b.first, b.value, Eigen::Matrix3d(Eigen::Matrix3d::Identity()));
        rows.target.segment<3>(row) = data_.points[cut.point];
        row += 3;
      }
      if (!cut.along.isZero()) {
        rows.add(row, b.first, b.slope, tangents_of(cut.along.normalized()).transpose().eval());
        row += 2;
      } else if (!data_.normals.empty() && !data_.normals[cut.point].isZero()) {
        rows.add(row++, b.first, b.slope, data_.normals[cut.point].transpose().eval());
      }
    }
    rows.target.conservativeResize(row);
    Matrix held;
    Eigen::VectorXd target;
    reduce(rows, held, target);
    const Eigen::MatrixXd moves = factors.solve(Eigen::MatrixXd(held.transpose()));
    for (int round = 0; round < 2; ++round)  // the second pass removes rounding errors
      free += moves * (held * moves).ldlt().solve(target - held * free);
  }

  const CurveData& data_;
  int spans_;
  Eigen::VectorXd fixed_;
  Matrix basis_;
};

// The parameter of the curve's nearest point to p, starting nearby.
double foot_of(const SplineCurve& curve, const Vec3& p, double t) {
  for (int step = 0; step < 6; ++step) {
    const CurvePoint c = curve.at(t);
    const double square = c.tangent.squaredNorm();
    if (!(square > 0)) break;
    const double next = std::clamp(t + c.tangent.dot(p - c.at) / square, 0.0, 1.0);
    const double change = std::abs(next - t);
    t = next;
    if (change < single_roundoff) break;
  }
  return t;
}

void measure(const CurveData& data, FittedCurve& curve) {
  for (std::size_t k = 0; k < data.points.size(); ++k)
    curve.off.push_back(
        (off_surface(data, k) * (curve.curve.at(curve.parameters[k]).at - data.points[k])).norm());
  curve.error = *std::max_element(curve.off.begin(), curve.off.end());
}

std::vector<double> even_parameters(std::size_t count) {
  std::vector<double> t(count);
  for (std::size_t k = 0; k < count; ++k) t[k] = double(k) / double(count - 1);
  return t;
}

// By the length of the polygon within each control edge, so that vertices are at knots. In a halved
// edge by a rational function of the length, which maps the midpoint to 1/2.
std::vector<double> length_parameters(const CurveData& data) {
  const std::size_t each = (data.points.size() - 1) / std::size_t(data.edges);
  std::vector<double> t;
  for (std::size_t e = 0; e < std::size_t(data.edges); ++e) {
    std::vector<double> own{0.0};
    for (std::size_t k = e * each; k < (e + 1) * each; ++k)
      own.push_back(own.back() + (data.points[k + 1] - data.points[k]).norm());
    const double all = own.back(), middle = data.halved() ? own[each / 2] / all : 0.5;
    if (!(middle > 0 && middle < 1 && all > 0)) return even_parameters(data.points.size());
    own.pop_back();
    for (const double at : own)
      t.push_back((double(e) + at / all * (1 - middle) / (at / all * (1 - 2 * middle) + middle)) /
                  data.edges);
  }
  t.push_back(1);
  return t;
}

// By the length of the whole polygon.
std::vector<double> whole_length_parameters(const std::vector<Vec3>& points) {
  std::vector<double> t{0.0};
  for (std::size_t k = 1; k < points.size(); ++k)
    t.push_back(t.back() + (points[k] - points[k - 1]).norm());
  if (const double all = t.back(); all > 0)
    for (double& at : t) at /= all;
  t.back() = 1;
  return t;
}

// The parameter whose length is `share` with shorter spans at both ends.
double graded(double share) {
  constexpr double turn = 2 * std::numbers::pi;
  double t = share;
  for (int step = 0; step < 6; ++step) {  // Newton's method, to rounding
    const double off = t - (1 - end_share) / turn * std::sin(turn * t) - share;
    t = std::clamp(t - off / (1 - (1 - end_share) * std::cos(turn * t)), 0.0, 1.0);
  }
  return t;
}

FittedCurve fit_evenly(const CurveData& data, const CurveSystem& system) {
  FittedCurve out;
  out.normals = data.normals;
  out.parameters = even_parameters(data.points.size());
  out.curve = system.solve(out.parameters, {});
  measure(data, out);
  return out;
}

// Whether the curve near the points at t has their direction and never turns back. Sliding points
// may pull its end beyond the last point, where it turns back and adjacent patches fold. The same
// happens in corners of less than 45° where it almost stops.
bool runs_along(const SplineCurve& curve, const CurveData& data, const std::vector<double>& t) {
  const std::size_t last = data.points.size() - 1;
  Vec3 before = curve.at(0).tangent;
  for (std::size_t k = 0; k <= last; ++k) {
    Vec3 line = data.points[std::min(k + 1, last)] - data.points[k ? k - 1 : 0];
    if (!data.normals.empty()) line -= line.dot(data.normals[k]) * data.normals[k];
    const Vec3 tangent = curve.at(t[k]).tangent;
    if (tangent.dot(line) < tangent.cross(line).norm() || tangent.dot(before) < 0) return false;
    before = tangent;
  }
  const double mean = length_of(data.points);
  for (const std::size_t end : {0u, 1u})
    if (data.corner[end] < std::numbers::pi / 4 &&
        curve.at(double(end)).tangent.norm() < slowest * mean)
      return false;
  return true;
}

// Moves the points from their first places to their feet.
FittedCurve fit_from(const CurveData& data, const CurveSystem& system,
                     std::vector<double> parameters) {
  FittedCurve out;
  out.normals = data.normals;
  out.parameters = std::move(parameters);
  out.curve = system.solve(out.parameters, {});
  const std::size_t last = data.points.size() - 1;
  for (int round = 0; round <= refits; ++round) {
    std::vector<Vec3> along{out.curve.at(0).tangent.normalized()};
    for (std::size_t k = 1; k <= last; ++k) {
      double& t = out.parameters[k];
      if (k < last && !data.is_cut(k)) t = foot_of(out.curve, data.points[k], t);
      along.push_back(out.curve.at(t).tangent.normalized());
    }
    if (round == refits) break;
    SplineCurve next = system.solve(out.parameters, along);
    if (!runs_along(next, data, out.parameters)) break;
    out.curve = std::move(next);
  }
  measure(data, out);
  return out;
}

FittedCurve fit_with(const CurveData& data, int spans, double tolerance) {
  const CurveSystem system(data, spans);
  FittedCurve even = fit_evenly(data, system);
  const double exact = roundoff * length_of(data.points);
  // the lattice's parameters, as for creases
  if (data.own || even.error <= exact) return even;
  if (data.edges > 1 && data.is_uncut()) {
    // A straight line along edges of very different lengths: with vertices at knots it turns back, or
    // almost, and the patches beside it fold.
    FittedCurve whole = fit_from(data, system, whole_length_parameters(data.points));
    if (whole.error <= exact) return whole;
  }
  std::vector<double> start = length_parameters(data);
  FittedCurve plain = fit_from(data, system, start);
  if (plain.error <= tolerance || (spans <= 2 && data.edges == 1)) return plain;
  if (data.edges == 1)  // only if there are spans between those at the ends
    for (double& t : start) t = graded(t);
  else  // a border or crease is smooth in the lattice's parameters
    start = even_parameters(data.points.size());
  FittedCurve other = fit_from(data, system, std::move(start));
  return other.error < plain.error ? other : plain;
}

}  // namespace

Vec3 across(const Vec3& normal, const Vec3& tangent) {
  return unit_or_zero(normal - normal.dot(tangent) * tangent);
}

Vec3 normal_at(const FittedCurve& curve, double t) {
  const auto after = std::upper_bound(curve.parameters.begin() + 1, curve.parameters.end() - 1, t);
  const auto k = std::size_t(after - curve.parameters.begin());
  const double from = curve.parameters[k - 1], width = curve.parameters[k] - from;
  const double share = width > 0 ? (t - from) / width : 0.0;
  const Vec3 normal = (1 - share) * curve.normals[k - 1] + share * curve.normals[k];
  const Vec3 tangent = curve.curve.at(t).tangent.normalized();
  return across(normal, tangent);
}

FittedCurve fit_curve(const CurveData& data, const SpanLimits& limits) {
  FittedCurve best = fit_with(data, limits.least, limits.tolerance);
  for (int spans = 2 * limits.least; spans <= limits.most && best.error > limits.tolerance;
       spans *= 2) {
    FittedCurve next = fit_with(data, spans, limits.tolerance);
    if (next.error < best.error) best = std::move(next);
  }
  best.own = data.own;
  for (std::size_t k = 0; k < best.normals.size(); ++k) {
    const Vec3 tangent = best.curve.at(best.parameters[k]).tangent.normalized();
    if (const Vec3 turned = across(best.normals[k], tangent); !turned.isZero())
      best.normals[k] = turned;
  }
  return best;
}

}  // namespace fairing
