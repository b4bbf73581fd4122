// SPDX-License-Identifier: GPL-3.0-or-later
#include "hold/load_steps.h"

#include <Eigen/Dense>

namespace fairing {
namespace {

constexpr std::size_t depth = 6;          // corrections that are remembered
constexpr double regularization = 1e-12;  // of the least squares' diagonal

}  // namespace

template <int N>
LoadsOf<N> LoadSteps<N>::change(const LoadsOf<N>& correction) {
  LoadsOf<N> out = correction;
  if (!last_.empty()) {
    Pair pair{last_, last_change_, {}};
    for (std::size_t v = 0; v < out.size(); ++v) pair.bent[v] = correction[v] - pair.bent[v];
    pads_.multiply_mass<N>(pair.bent, pair.product);
    pairs_.push_back(std::move(pair));
    if (pairs_.size() > depth) pairs_.pop_front();
  }
  if (!pairs_.empty()) {
    const auto count = Eigen::Index(pairs_.size());
    Eigen::MatrixXd gram(count, count);
    Eigen::VectorXd right(count);
    for (Eigen::Index a = 0; a < count; ++a) {
      const Pair& pair = pairs_[std::size_t(a)];
      right(a) = dot<N>(pair.product, correction);
      for (Eigen::Index b = 0; b < count; ++b)
        gram(a, b) = dot<N>(pair.product, pairs_[std::size_t(b)].bent);
    }
    gram.diagonal() *= 1 + regularization;
    const Eigen::VectorXd share = gram.ldlt().solve(right);
    if (share.allFinite())
      for (Eigen::Index a = 0; a < count; ++a) {
        const Pair& pair = pairs_[std::size_t(a)];
        for (std::size_t v = 0; v < out.size(); ++v)
          out[v] -= share(a) * (pair.bent[v] + pair.gone[v]);
      }
  }
  last_ = correction;
  last_change_ = out;
  return out;
}

template class LoadSteps<1>;
template class LoadSteps<3>;

}  // namespace fairing
