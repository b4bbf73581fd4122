// SPDX-License-Identifier: GPL-3.0-or-later
#include "strain/ease.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "parallel/cancel.h"

namespace fairing {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

// Up to so many unknowns all eigenvalues are found: 0.1 s.
constexpr Eigen::Index few = 400;
// Of Lanczos, and vectors of signs whose mean is the trace (Hutchinson 1990). With over `few`
// unknowns the trace is within 3 per cent, alike for all amounts.
constexpr int lanczos_steps = 60, sign_vectors = 8;
// Of conjugate gradients.
constexpr double step_tolerance = 1e-5;
constexpr int most_steps = 500;
// Amounts that are tried, times the mean of G's eigenvalues: ten a decade.
constexpr double least_amount = 1e-3, ten_a_decade = 1.2589254117941673;
constexpr int amounts = 61;
constexpr int halvings = 14;
// How much the score keeps of what plain cross-validation says: 1 is all. On 35 vertices with little
// scatter that chose no amount at all in three of sixteen cases, and with 0.8 in none; below, more is
// eased than is best.
constexpr double robustness = 0.8;
// Of bounds: what is left over them, relative, before moves are put onto them.
constexpr double bound_tolerance = 1e-3;
constexpr int most_rounds = 60;
// What holds an unknown with the bound 0, over the diagonal.
constexpr double stays = 1e9;

// Signs by Steele's splitmix64.
VectorXd random_signs(Eigen::Index n, std::uint64_t seed) {
  VectorXd out(n);
  std::uint64_t state = seed;
  for (double& sign : out) {
    std::uint64_t z = state += 0x9e3779b97f4a7c15u;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    sign = (z ^ (z >> 31)) & 1 ? 1.0 : -1.0;
  }
  return out;
}

double largest_share(const Columns& moves, const VectorXd& bounds) {
  double largest = 0;
  for (Eigen::Index j = 0; j < moves.rows(); ++j)
    if (bounds[j] > 0) largest = std::max(largest, moves.row(j).norm() / bounds[j]);
  return largest;
}

}  // namespace

EaseSystem::EaseSystem(LoadMatrix g, Columns loads)
    : g_(std::move(g)), transposed_(g_.transpose()), loads_(std::move(loads)) {
  pulls_ = transposed_ * loads_;
  diagonal_ = VectorXd::Zero(unknowns());
  for (Eigen::Index j = 0; j < unknowns(); ++j) diagonal_[j] = transposed_.row(j).squaredNorm();
  if (unknowns() == 0) return;
  mean_ = std::sqrt(diagonal_.mean());
  if (!(mean_ > 0)) return;
  if (unknowns() <= few)
    find_eigenvalues();
  else
    probe_eigenvalues();
}

void EaseSystem::find_eigenvalues() {
  const MatrixXd dense = g_;
  product_ = dense.transpose() * dense;
  const Eigen::SelfAdjointEigenSolver<MatrixXd> found(product_);
  values_ = found.eigenvalues().cwiseMax(0.0);
  vectors_ = found.eigenvectors();
  const Columns parts = vectors_.transpose() * pulls_;
  for (Eigen::Index k = 0; k < unknowns(); ++k) {
    of_pulls_.node.push_back(values_[k]);
    of_pulls_.weight.push_back(parts.row(k).squaredNorm());
    of_trace_.weight.push_back(1);
  }
  of_trace_.node = of_pulls_.node;
}

void EaseSystem::probe_eigenvalues() {
  const auto add = [](const Quadrature& more, double share, Quadrature& all) {
    all.node.insert(all.node.end(), more.node.begin(), more.node.end());
    for (const double weight : more.weight) all.weight.push_back(share * weight);
  };
  for (int a = 0; a < 3; ++a) add(lanczos(pulls_.col(a)), 1, of_pulls_);
  for (int k = 0; k < sign_vectors; ++k)
    add(lanczos(random_signs(unknowns(), std::uint64_t(k + 1))), 1.0 / sign_vectors, of_trace_);
}

// Without a second orthogonalization: a sum over eigenvalues does not mind some of them twice.
EaseSystem::Quadrature EaseSystem::lanczos(const VectorXd& from) const {
  Quadrature out;
  const double length = from.norm();
  if (!(length > 0)) return out;
  VectorXd before = VectorXd::Zero(from.size()), now = from / length;
  std::vector<double> diagonal, beside;
  for (int k = 0; k < lanczos_steps; ++k) {
    stop_if_cancelled();
    VectorXd next = transposed_ * (g_ * now).eval();
    if (k > 0) next -= beside.back() * before;
    diagonal.push_back(now.dot(next));
    next -= diagonal.back() * now;
    const double left = next.norm();
    if (k + 1 == lanczos_steps || !(left > 1e-12 * diagonal.front())) break;
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
  for (std::size_t k = 0; k < of_pulls_.node.size(); ++k) {
    const double filter = s * s / (1 + s * s * of_pulls_.node[k]);
    sum += of_pulls_.weight[k] * filter * filter;
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

double EaseSystem::squared_trace(double s) const {
  double sum = 0;
  for (std::size_t k = 0; k < of_trace_.node.size(); ++k) {
    const double kept = 1 / (1 + s * s * of_trace_.node[k]);
    sum += of_trace_.weight[k] * kept * kept;
  }
  return sum;
}

// Of the matrix of (*).
Columns EaseSystem::multiply(double s, const VectorXd& stiffness, const Columns& d) const {
  Columns out = s * s * (transposed_ * (g_ * d).eval()) + d;
  if (stiffness.size() > 0) out += stiffness.asDiagonal() * d;
  return out;
}

// Conjugate gradients, all columns side by side, on the diagonal.
Columns EaseSystem::solve_by_steps(double s, const VectorXd& stiffness) const {
  VectorXd inverse = (s * s * diagonal_).array() + 1;
  if (stiffness.size() > 0) inverse += stiffness;
  inverse = inverse.cwiseInverse();
  Columns d = Columns::Zero(unknowns(), 3), left = -s * s * pulls_,
          ahead = inverse.asDiagonal() * left;
  const Columns smooth = ahead;
  Eigen::RowVector3d energy = left.cwiseProduct(smooth).colwise().sum();
  const double wanted = step_tolerance * step_tolerance * energy.sum();
  for (int k = 0; k < most_steps && energy.sum() > wanted; ++k) {
    stop_if_cancelled();
    const Columns product = multiply(s, stiffness, ahead);
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

Columns EaseSystem::moves(double s, const VectorXd& stiffness) const {
  if (!(mean_ > 0) || !(s > 0)) return Columns::Zero(unknowns(), 3);
  if (values_.size() == 0) return solve_by_steps(s, stiffness);
  if (stiffness.size() == 0) {
    const VectorXd filter = s * s * (1 + s * s * values_.array()).inverse();
    return -(vectors_ * (filter.asDiagonal() * (vectors_.transpose() * pulls_)).eval());
  }
  MatrixXd all = s * s * product_;
  all.diagonal() += VectorXd(stiffness.array() + 1);
  return -s * s * all.llt().solve(pulls_);
}

// The bounds' multipliers are stiffnesses, found by a Newton step for each as if it were alone.
Columns EaseSystem::moves_within(double s, const VectorXd& bounds) const {
  const VectorXd own = (s * s * diagonal_).array() + 1;
  VectorXd stiffness = VectorXd::Zero(unknowns());
  for (Eigen::Index j = 0; j < unknowns(); ++j)
    if (!(bounds[j] > 0)) stiffness[j] = stays * own[j];
  Columns d;
  for (int round = 0; round < most_rounds; ++round) {
    stop_if_cancelled();
    d = moves(s, stiffness);
    bool settled = true;
    for (Eigen::Index j = 0; j < unknowns(); ++j) {
      if (!(bounds[j] > 0)) continue;
      const double share = d.row(j).norm() / bounds[j];
      settled = settled && share <= 1 + bound_tolerance &&
                (stiffness[j] == 0 || share >= 1 - bound_tolerance);
      stiffness[j] = std::max(0.0, (own[j] + stiffness[j]) * share - own[j]);
    }
    if (settled) break;
  }
  for (Eigen::Index j = 0; j < unknowns(); ++j) {
    const double length = d.row(j).norm();
    if (length > bounds[j]) d.row(j) *= bounds[j] / length;
  }
  return d;
}

double cross_validated(const EaseSystem& system) {
  if (!(system.mean() > 0)) return 0;
  double best = 0, least = std::numeric_limits<double>::infinity();
  double s = least_amount / system.mean();
  for (int i = 0; i < amounts; ++i, s *= ten_a_decade) {
    const double trace = system.trace(s);
    const double kept = system.squared_trace(s) / double(system.unknowns());
    const double score =
        system.squared_moves(s) / (trace * trace) * (robustness + (1 - robustness) * kept);
    if (score < least) {
      least = score;
      best = s;
    }
  }
  return best;
}

double largest_within(const EaseSystem& system, const VectorXd& bounds) {
  if (!(system.mean() > 0)) return 0;
  VectorXd held;
  if (!(bounds.array() > 0).all())
    held = (bounds.array() > 0)
               .select(VectorXd::Zero(bounds.size()), VectorXd::Constant(bounds.size(), stays));
  const auto within = [&](double s) {
    stop_if_cancelled();
    return largest_share(system.moves(s, held), bounds) <= 1;
  };
  double low = std::log(least_amount / system.mean());
  double high = low + (amounts - 1) * std::log(ten_a_decade);
  if (within(std::exp(high))) return std::exp(high);
  if (!within(std::exp(low))) return 0;
  for (int i = 0; i < halvings; ++i) {
    const double middle = 0.5 * (low + high);
    (within(std::exp(middle)) ? low : high) = middle;
  }
  return std::exp(low);
}

}  // namespace fairing
