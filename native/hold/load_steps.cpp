// SPDX-License-Identifier: GPL-3.0-or-later
#include "hold/load_steps.h"

#include <Eigen/Dense>

namespace fairing {
namespace {

constexpr std::size_t depth = 6;          // corrections that are remembered
constexpr double regularization = 1e-12;  // of the least squares' diagonal

template <int N>
double dot_all(const Multipliers<N>& a, const Multipliers<N>& b) {
  double sum = dot<N>(a.loads, b.loads);
  for (std::size_t v = 0; v < a.bounds.size(); ++v) sum += a.bounds[v] * b.bounds[v];
  return sum;
}

// a <- a + factor b
template <int N>
void add(double factor, const Multipliers<N>& b, Multipliers<N>& a) {
  for (std::size_t v = 0; v < a.loads.size(); ++v) a.loads[v] += factor * b.loads[v];
  for (std::size_t v = 0; v < a.bounds.size(); ++v) a.bounds[v] += factor * b.bounds[v];
}

}  // namespace

template <int N>
void LoadSteps<N>::forget() {
  pairs_.clear();
  any_ = false;
}

template <int N>
Multipliers<N> LoadSteps<N>::product(const Multipliers<N>& a) const {
  Multipliers<N> out;
  if (pads_) pads_->multiply_mass<N>(a.loads, out.loads);
  for (std::size_t v = 0; v < a.bounds.size(); ++v) out.bounds.push_back(weight_[v] * a.bounds[v]);
  return out;
}

template <int N>
Multipliers<N> LoadSteps<N>::change(const Multipliers<N>& correction) {
  Multipliers<N> out = correction;
  if (any_) {
    Pair pair{correction, last_change_, {}};
    add(-1, last_, pair.bent);
    pair.product = product(pair.bent);
    pairs_.push_back(std::move(pair));
    if (pairs_.size() > depth) pairs_.pop_front();
  }
  if (!pairs_.empty()) {
    const auto count = Eigen::Index(pairs_.size());
    Eigen::MatrixXd gram(count, count);
    Eigen::VectorXd right(count);
    for (Eigen::Index a = 0; a < count; ++a) {
      const Pair& pair = pairs_[std::size_t(a)];
      right(a) = dot_all(pair.product, correction);
      for (Eigen::Index b = 0; b < count; ++b)
        gram(a, b) = dot_all(pair.product, pairs_[std::size_t(b)].bent);
    }
    gram.diagonal() *= 1 + regularization;
    const Eigen::VectorXd share = gram.ldlt().solve(right);
    if (share.allFinite())
      for (Eigen::Index a = 0; a < count; ++a) {
        Multipliers<N> both = pairs_[std::size_t(a)].bent;
        add(1, pairs_[std::size_t(a)].gone, both);
        add(-share(a), both, out);
      }
  }
  any_ = true;
  last_ = correction;
  last_change_ = out;
  return out;
}

template class LoadSteps<1>;
template class LoadSteps<3>;

}  // namespace fairing
