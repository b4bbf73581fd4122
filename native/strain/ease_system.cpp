// SPDX-License-Identifier: GPL-3.0-or-later
#include "strain/ease_system.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <cstdint>

#include "base/mixed.h"
#include "base/roundoff.h"
#include "parallel/cancel.h"

namespace fairing {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

// Up to this number of unknowns all eigenvalues are computed, in 0.3 s.
constexpr Eigen::Index most_dense = 600;
// for Lanczos
constexpr int quadrature_nodes = 60;
// Amounts that are tried, times the mean of G's eigenvalues: ten a decade, up to 1 / the least.
constexpr double least_amount = 1e-3, ten_a_decade = 1.2589254117941673;
// Weight of plain cross-validation in the score; 1 is plain. With 35 vertices and little scatter,
// plain cross-validation chose no amount in three of sixteen cases, this weight in none; smaller
// weights ease more than is best.
constexpr double robustness = 0.8;
// Scatter is faint if the score without easing is less than `faint` times the least score. Then the
// smallest amount with a score within `leeway` of the least is chosen: the loads of uneven stars
// are as large as the scatter, and cross-validation does not distinguish them. On eight shapes of
// 28 to 162 unknowns, scattered by 0.0025 to 0.04 of an edge, errors are on average 1.10 times
// those of the best amount, and 1.19 times with the least score; a sphere scattered by 0.005 ended
// with 1.5 times its error.
constexpr double faint = 2, leeway = 1.15;
// Relative to the largest bound or free move: the difference between moves and their bounded copies,
// and their change, at convergence.
constexpr double bound_tolerance = 1e-3;
constexpr int most_iterations = 200;  // of the alternating directions

VectorXd random_signs(Eigen::Index n, std::uint64_t seed) {
  VectorXd out(n);
  for (double& sign : out) {
    sign = mixed(seed) & 1 ? 1.0 : -1.0;
    seed += mixed_apart;
  }
  return out;
}

// Rows longer than their bounds are shortened to them.
Columns bounded(Columns rows, const VectorXd& bounds) {
  for (Eigen::Index j = 0; j < rows.rows(); ++j) {
    const double length = rows.row(j).norm();
    if (length > bounds[j]) rows.row(j) *= bounds[j] / length;
  }
  return rows;
}

}  // namespace

EaseSystem::EaseSystem(LoadMatrix g, Columns loads)
    : g_(std::move(g)), transposed_(g_.transpose()) {
  diagonal_ = VectorXd::Zero(unknowns());
  for (Eigen::Index j = 0; j < unknowns(); ++j) diagonal_[j] = transposed_.row(j).squaredNorm();
  if (unknowns() > 0) mean_ = std::sqrt(diagonal_.mean());
  if (mean_ > 0) find_eigenvalues();
  set_loads(std::move(loads));
}

EaseSystem EaseSystem::with_loads(Columns loads) const {
  EaseSystem out = *this;
  out.set_loads(std::move(loads));
  return out;
}

void EaseSystem::find_eigenvalues() {
  if (unknowns() > most_dense) {
    // The trace is estimated by vectors of random signs (Hutchinson 1990). With three and over
    // `most_dense` unknowns the error is within 5 per cent.
    for (const std::uint64_t seed : {1, 2, 3})
      add(lanczos(random_signs(unknowns(), seed)), 1.0 / 3, of_trace_);
    return;
  }
  const MatrixXd dense = g_;
  const Eigen::SelfAdjointEigenSolver<MatrixXd> found(MatrixXd(dense.transpose() * dense));
  values_ = found.eigenvalues().cwiseMax(0.0);
  vectors_ = found.eigenvectors();
  of_trace_.node.assign(values_.begin(), values_.end());
  of_trace_.weight.assign(std::size_t(unknowns()), 1);
}

void EaseSystem::set_loads(Columns loads) {
  loads_ = std::move(loads);
  gradient_ = transposed_ * loads_;
  of_gradient_ = {};
  if (!(mean_ > 0)) return;
  if (values_.size() == 0) {
    for (Eigen::Index a = 0; a < gradient_.cols(); ++a)
      add(lanczos(gradient_.col(a)), 1, of_gradient_);
    return;
  }
  const VectorXd weights = (vectors_.transpose() * gradient_).rowwise().squaredNorm();
  of_gradient_.node = of_trace_.node;
  of_gradient_.weight.assign(weights.begin(), weights.end());
}

void EaseSystem::add(const Quadrature& more, double share, Quadrature& all) {
  all.node.insert(all.node.end(), more.node.begin(), more.node.end());
  for (const double weight : more.weight) all.weight.push_back(share * weight);
}

// Without a second orthogonalization: repeated eigenvalues do not change the sum.
EaseSystem::Quadrature EaseSystem::lanczos(const VectorXd& from) const {
  Quadrature out;
  const double length = from.norm();
  if (!(length > 0)) return out;
  VectorXd before = VectorXd::Zero(from.size()), now = from / length;
  std::vector<double> diagonal, beside;
  for (int k = 0; k < quadrature_nodes; ++k) {
    stop_if_cancelled();
    VectorXd next = transposed_ * (g_ * now).eval();
    if (k > 0) next -= beside.back() * before;
    diagonal.push_back(now.dot(next));
    next -= diagonal.back() * now;
    const double left = next.norm();
    if (k + 1 == quadrature_nodes || !(left > roundoff * diagonal.front())) break;
    beside.push_back(left);
    before = std::exchange(now, next / left);
  }
  Eigen::SelfAdjointEigenSolver<MatrixXd> found;
  found.computeFromTridiagonal(
      Eigen::Map<const VectorXd>(diagonal.data(), Eigen::Index(diagonal.size())),
      Eigen::Map<const VectorXd>(beside.data(), Eigen::Index(beside.size())));
  for (Eigen::Index k = 0; k < found.eigenvalues().size(); ++k) {
    out.node.push_back(std::max(0.0, found.eigenvalues()[k]));
    const double part = length * found.eigenvectors()(0, k);
    out.weight.push_back(part * part);
  }
  return out;
}

double EaseSystem::squared_moves(double s) const {
  double sum = 0;
  for (std::size_t k = 0; k < of_gradient_.node.size(); ++k) {
    const double filter = s * s / (1 + s * s * of_gradient_.node[k]);
    sum += of_gradient_.weight[k] * filter * filter;
  }
  return sum;
}

double EaseSystem::trace(double s) const {
  double sum = 0;
  for (std::size_t k = 0; k < of_trace_.node.size(); ++k) {
    const double value = s * s * of_trace_.node[k];
    sum += of_trace_.weight[k] * value / (1 + value);
  }
  return sum;
}

double EaseSystem::noise(double s) const {
  const double all = trace(s);
  return all > 0 ? std::sqrt(squared_moves(s) / all) : 0;
}

double EaseSystem::squared_trace(double s) const {
  double sum = 0;
  for (std::size_t k = 0; k < of_trace_.node.size(); ++k) {
    const double kept = 1 / (1 + s * s * of_trace_.node[k]);
    sum += of_trace_.weight[k] * kept * kept;
  }
  return sum;
}

// The kurtosis of the moves' components along the eigenvectors, in units of the filter, is at most
// three standard deviations above its mean for n normal numbers about zero, whose squares over
// their sum have a Dirichlet distribution; for scatter in several directions it is less. If n is so
// small that a single component with all of the sum would pass, the test says nothing.
bool EaseSystem::may_be_scatter(double s) const {
  if (values_.size() == 0) return true;
  double squares = 0, fourths = 0, moved = 0, moved_squared = 0;
  for (Eigen::Index k = 0; k < values_.size(); ++k) {
    const double filter = s * s / (1 + s * s * values_[k]);
    const double kept = filter * values_[k],
                 part = of_gradient_.weight[std::size_t(k)] * filter * filter;
    squares += kept * kept;
    fourths += kept * kept * kept * kept;
    moved += part;
    moved_squared += part * part;
  }
  if (!(moved > 0)) return false;
  const double n = squares * squares / fourths;
  const double deviation = std::sqrt(24 * (n - 1) / ((n + 4) * (n + 6)));
  const double most = n / (n + 2) * 3 * (1 + deviation);
  return n > most && n * moved_squared <= most * moved * moved;
}

// Uses eigenvectors, or conjugate gradients with the diagonal, for all columns together.
Columns EaseSystem::solve(double s, double shift, const Columns& wanted,
                          const Columns& start) const {
  if (values_.size() > 0) {
    const VectorXd filter = (s * s * values_.array() + 1 + shift).inverse();
    return vectors_ * (filter.asDiagonal() * (vectors_.transpose() * wanted)).eval();
  }
  const auto multiply = [&](const Columns& d) -> Columns {
    return s * s * (transposed_ * (g_ * d).eval()) + (1 + shift) * d;
  };
  const VectorXd inverse = (s * s * diagonal_.array() + 1 + shift).inverse();
  Columns d = start, left = wanted - multiply(d), ahead = inverse.asDiagonal() * left;
  Eigen::RowVector3d energy = left.cwiseProduct(ahead).colwise().sum();
  const double scale = wanted.cwiseProduct(inverse.asDiagonal() * wanted).sum();
  const double least = single_roundoff * single_roundoff * scale;
  for (Eigen::Index k = 0; k < unknowns() && energy.sum() > least; ++k) {
    stop_if_cancelled();
    const Columns product = multiply(ahead);
    const Eigen::RowVector3d curvature = ahead.cwiseProduct(product).colwise().sum();
    for (int a = 0; a < 3; ++a) {
      if (!(curvature[a] > 0)) continue;
      const double step = energy[a] / curvature[a];
      d.col(a) += step * ahead.col(a);
      left.col(a) -= step * product.col(a);
    }
    const Columns next = inverse.asDiagonal() * left;
    for (int a = 0; a < 3; ++a) {
      const double now = left.col(a).dot(next.col(a));
      ahead.col(a) = next.col(a) + (energy[a] > 0 ? now / energy[a] : 0.0) * ahead.col(a);
      energy[a] = now;
    }
  }
  return d;
}

Columns EaseSystem::moves(double s) const {
  Columns none = Columns::Zero(unknowns(), 3);
  if (!(mean_ > 0) || !(s > 0)) return none;
  return solve(s, 0, -s * s * gradient_, none);
}

// A weight between the extreme eigenvalues of (*) couples the moves and their bounded copies.
Columns EaseSystem::moves_within(double s, const VectorXd& bounds) const {
  Columns d = moves(s);
  const double largest = std::min(bounds.maxCoeff(), d.rowwise().norm().maxCoeff());
  const double weight = 1 + s * mean_;
  const Columns wanted = -s * s * gradient_;
  Columns within = bounded(d, bounds), apart = d - within;
  if (apart.isZero(0)) return within;
  for (int round = 0; round < most_iterations; ++round) {
    stop_if_cancelled();
    d = solve(s, weight, wanted + weight * (within - apart), d);
    const Columns next = bounded(d + apart, bounds);
    const double left = std::max((next - within).rowwise().norm().maxCoeff(),
                                 (d - next).rowwise().norm().maxCoeff());
    apart += d - next;
    within = next;
    if (left <= bound_tolerance * largest) break;
  }
  return within;
}

namespace {

// All amounts that are tried, ascending; none if G is zero.
std::vector<double> ladder(const EaseSystem& system) {
  std::vector<double> out;
  if (!(system.mean() > 0)) return out;
  for (double s = least_amount; s * least_amount < ten_a_decade; s *= ten_a_decade)
    out.push_back(s / system.mean());
  return out;
}

}  // namespace

double least_score(const EaseSystem& system) {
  const std::vector<double> amount = ladder(system);
  if (amount.empty()) return 0;
  std::vector<double> score;
  for (const double s : amount) {
    const double trace = system.trace(s);
    const double kept = system.squared_trace(s) / double(system.unknowns());
    score.push_back(system.squared_moves(s) / (trace * trace) *
                    (robustness + (1 - robustness) * kept));
  }
  const auto best = std::min_element(score.begin(), score.end());
  if (!std::isfinite(*best)) return 0;
  const auto chosen = score.front() > faint * *best
                          ? best
                          : std::find_if(score.begin(), score.end(),
                                         [&](double of) { return of <= leeway * *best; });
  return chosen == score.begin() ? 0 : amount[std::size_t(chosen - score.begin())];
}

double cross_validated(const EaseSystem& system) {
  const double s = least_score(system);
  return system.may_be_scatter(s) ? s : 0;
}

// Moves grow with the amount, so bisection finds it.
double with_moves_within(const EaseSystem& system, const VectorXd& bounds) {
  const std::vector<double> amount = ladder(system);
  const auto fits = [&](double s) {
    const Columns moves = system.moves(s);
    for (Eigen::Index j = 0; j < system.unknowns(); ++j)
      if (bounds[j] > 0 && moves.row(j).norm() > bounds[j]) return false;
    return true;
  };
  const auto outside = std::partition_point(amount.begin(), amount.end(), fits);
  return outside == amount.begin() ? 0 : *(outside - 1);
}

// Computes the moves: Lanczos' least eigenvalues are too inaccurate for large amounts.
double with_noise_up_to(const EaseSystem& system, double s, double noise) {
  std::vector<double> amount = ladder(system);
  amount.erase(std::upper_bound(amount.begin(), amount.end(), s), amount.end());
  const auto fits = [&](double of) {
    return system.moves(of).squaredNorm() <= noise * noise * system.trace(of);
  };
  const auto outside = std::partition_point(amount.begin(), amount.end(), fits);
  return outside == amount.begin() ? 0 : *(outside - 1);
}

}  // namespace fairing
