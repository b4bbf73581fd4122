// SPDX-License-Identifier: GPL-3.0-or-later
#include "splines/curve_fit.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/points.h"
#include "base/rounding.h"
#include "splines/lattice.h"

namespace fairing {
namespace {

// What sliding along the curve counts, what leaving the lattice's line within the surface does. A
// tangent out of the surface's tangent plane counts their product.
constexpr double slide = 0.1, aside = 0.2;
constexpr int refits = 3;  // each after the points have moved to their feet
// Curvature has a pole at control vertices, where most energies hold the surface: spans that are
// shorter towards both ends, by this share, follow it.
constexpr double end_share = 0.35;
// Of its mean speed: no curve comes slower to a narrow corner.
constexpr double slowest = 0.3;

double length_of(const std::vector<Vec3>& points) {
  double length = 0;
  for (std::size_t k = 1; k < points.size(); ++k) length += (points[k] - points[k - 1]).norm();
  return length;
}

// What a distance from point k counts. A smooth curve has to lie on the surface; where in it, is
// almost its own affair.
Eigen::Matrix3d off_surface(const CurveData& data, std::size_t k) {
  const Eigen::Matrix3d all = Eigen::Matrix3d::Identity();
  if (data.strict || data.normals.empty() || data.normals[k].isZero() || data.is_middle(k))
    return all;
  const Vec3& n = data.normals[k];
  return aside * all + (1 - aside) * n * n.transpose();
}

class CurveSystem {
 public:
  CurveSystem(const CurveData& data, int spans) : data_(data), spans_(spans) {
    const int count = control_points(spans);
    fixed_ = Eigen::VectorXd::Zero(3 * count);
    const bool smooth = !data.normals.empty();
    const bool at_start = smooth && data.normals.front().squaredNorm() > 0,
               at_end = smooth && data.normals.back().squaredNorm() > 0;
    const int free = 3 * (count - 2) - at_start - at_end;
    basis_ = Eigen::MatrixXd::Zero(3 * count, free);
    set_fixed(0, data.points.front());
    set_fixed(count - 1, data.points.back());
    int column = 0;
    for (int i = 1; i + 1 < count; ++i) {
      const bool first = i == 1 && at_start, last = i + 2 == count && at_end;
      if (first || last) {
        basis_.block<3, 2>(3 * i, column) =
            tangents_of(first ? data.normals.front() : data.normals.back());
        set_fixed(i, first ? data.points.front() : data.points.back());
        column += 2;
      } else {
        basis_.block<3, 3>(3 * i, column).setIdentity();
        column += 3;
      }
    }
  }

  // `along`: the tangents at the points; empty: all directions count alike.
  SplineCurve solve(const std::vector<double>& t, const std::vector<Vec3>& along) const {
    const bool tilted = !along.empty() && !data_.normals.empty();
    const Eigen::Index samples = Eigen::Index(t.size()), height = tilted ? 4 : 3;
    Eigen::MatrixXd rows = Eigen::MatrixXd::Zero(height * samples, fixed_.size());
    Eigen::VectorXd target = Eigen::VectorXd::Zero(height * samples);
    for (Eigen::Index k = 0; k < samples; ++k) {
      const std::size_t at = std::size_t(k);
      const CubicBasis b = cubic_basis(spans_, t[at]);
      Eigen::Matrix3d weight = Eigen::Matrix3d::Identity();
      if (data_.is_middle(at))
        weight /= slide;  // other curves start from it
      else if (!along.empty())
        weight =
            off_surface(data_, at) * (weight - (1 - slide) * along[at] * along[at].transpose());
      for (int i = 0; i < 4; ++i) {
        const Eigen::Index column = 3 * (b.first + i);
        rows.block<3, 3>(height * k, column) = b.value[std::size_t(i)] * weight;
        if (tilted)
          rows.block<1, 3>(height * k + 3, column) =
              slide * aside * b.slope[std::size_t(i)] * data_.normals[at].transpose();
      }
      target.segment<3>(height * k) = weight * data_.points[at];
    }
    const Eigen::MatrixXd reduced = rows * basis_;
    const Eigen::VectorXd rest = target - rows * fixed_;
    const Eigen::VectorXd free = reduced.colPivHouseholderQr().solve(rest);
    const Eigen::VectorXd all = fixed_ + basis_ * free;
    SplineCurve out{spans_, {}};
    for (Eigen::Index i = 0; i < all.size(); i += 3) out.points.push_back(all.segment<3>(i));
    return out;
  }

 private:
  void set_fixed(int i, const Vec3& at) { fixed_.segment<3>(3 * i) = at; }

  const CurveData& data_;
  int spans_;
  Eigen::VectorXd fixed_;
  Eigen::MatrixXd basis_;
};

// The parameter where the curve is closest to p, from one nearby.
double foot_of(const SplineCurve& curve, const Vec3& p, double t) {
  for (int step = 0; step < 6; ++step) {
    const CurvePoint c = curve.at(t);
    const double square = c.tangent.squaredNorm();
    if (!(square > 0)) break;
    const double next = std::clamp(t + c.tangent.dot(p - c.at) / square, 0.0, 1.0);
    const double change = std::abs(next - t);
    t = next;
    if (change < single_rounding) break;
  }
  return t;
}

double farthest(const SplineCurve& curve, const CurveData& data, const std::vector<double>& t) {
  double error = 0;
  for (std::size_t k = 0; k < data.points.size(); ++k)
    error = std::max(error, (off_surface(data, k) * (curve.at(t[k]).at - data.points[k])).norm());
  return error;
}

std::vector<double> even_parameters(std::size_t count) {
  std::vector<double> t(count);
  for (std::size_t k = 0; k < count; ++k) t[k] = double(k) / double(count - 1);
  return t;
}

// By the length of the points' polygon. Of a halved curve by that rational function of it which
// keeps both ends and has the middle point at 1/2.
std::vector<double> length_parameters(const CurveData& data) {
  std::vector<double> t{0.0};
  for (std::size_t k = 1; k < data.points.size(); ++k)
    t.push_back(t.back() + (data.points[k] - data.points[k - 1]).norm());
  const double all = t.back();
  if (!(all > 0)) return even_parameters(t.size());
  const double middle = data.halved ? t[t.size() / 2] / all : 0.5;
  if (!(middle > 0 && middle < 1)) return even_parameters(t.size());
  for (double& at : t) at = at / all * (1 - middle) / (at / all * (1 - 2 * middle) + middle);
  t.back() = 1;
  return t;
}

// The parameter whose span is by length at `share`, where spans at both ends are shorter.
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
  out.error = farthest(out.curve, data, out.parameters);
  return out;
}

// Whether the curve, which is near the points at t, runs along them rather than across, and nowhere
// turns back. Points that slide may draw its end beyond its last point: there it turns back, and
// patches beside it fold. So they do in corners of less than 45° where it almost stops.
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

FittedCurve fit_by_length(const CurveData& data, const CurveSystem& system, bool to_ends) {
  FittedCurve out;
  out.normals = data.normals;
  out.parameters = length_parameters(data);
  if (to_ends)
    for (double& t : out.parameters) t = graded(t);
  out.curve = system.solve(out.parameters, {});
  const std::size_t last = data.points.size() - 1;
  for (int round = 0; round <= refits; ++round) {
    std::vector<Vec3> along{out.curve.at(0).tangent.normalized()};
    for (std::size_t k = 1; k <= last; ++k) {
      double& t = out.parameters[k];
      if (k < last && !data.is_middle(k)) t = foot_of(out.curve, data.points[k], t);
      along.push_back(out.curve.at(t).tangent.normalized());
    }
    if (round == refits) break;
    SplineCurve next = system.solve(out.parameters, along);
    if (!runs_along(next, data, out.parameters)) break;
    out.curve = std::move(next);
  }
  out.error = farthest(out.curve, data, out.parameters);
  return out;
}

FittedCurve fit_with(const CurveData& data, int spans, double tolerance) {
  const CurveSystem system(data, spans);
  FittedCurve even = fit_evenly(data, system);
  // the lattice's own, as along creases
  if (data.own || even.error <= rounding * length_of(data.points)) return even;
  FittedCurve plain = fit_by_length(data, system, false);
  // where there are some between those at the ends
  if (spans <= 2 || plain.error <= tolerance) return plain;
  FittedCurve to_ends = fit_by_length(data, system, true);
  return to_ends.error < plain.error ? to_ends : plain;
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
