// SPDX-License-Identifier: GPL-3.0-or-later
#include "multigrid/strong_blocks.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "parallel/cancel.h"

namespace fairing {
namespace {

// Of two points' diagonals, in the geometric mean: weaker couplings bind nothing.
constexpr float least_coupling = 0.15f;

class Growth {
 public:
  Growth(const SymmetricRows& matrix, std::size_t most)
      : matrix_(matrix),
        most_(most),
        root_(matrix.first.size() - 1, 0.0f),
        coupling_(root_.size(), 0.0f),
        taken_(root_.size(), 0) {
    for (std::size_t p = 0; p < root_.size(); ++p)
      visit_row(p, [&](std::size_t q, float number) {
        if (p == q && number > 0) root_[p] = 1 / std::sqrt(number);
      });
  }

  StrongBlocks run() {
    blocks_.begin.push_back(0);
    for (std::size_t p = 0; p < root_.size(); ++p) {
      if (matrix_.first[p] == matrix_.first[p + 1]) continue;
      seeds_.push_back(Index(p));
      while (!seeds_.empty()) {
        const Index seed = seeds_.back();
        seeds_.pop_back();
        if (!taken_[std::size_t(seed)]) grow(seed);
      }
    }
    return std::move(blocks_);
  }

 private:
  using Candidate = std::pair<float, Index>;  // its coupling to the block, the point

  template <class Visit>
  void visit_row(std::size_t p, const Visit& visit) const {
    for (std::size_t k = matrix_.first[p]; k < matrix_.first[p + 1]; ++k)
      visit(std::size_t(matrix_.entry[k].first), matrix_.entry[k].second);
  }

  void grow(Index seed) {
    stop_if_cancelled();
    candidates_.assign(1, {0.0f, seed});
    while (!candidates_.empty() && blocks_.point.size() - blocks_.begin.back() < most_) {
      std::pop_heap(candidates_.begin(), candidates_.end());
      const auto [coupling, p] = candidates_.back();
      candidates_.pop_back();
      const bool out_of_date = coupling < coupling_[std::size_t(p)];
      if (!taken_[std::size_t(p)] && !out_of_date) take(std::size_t(p));
    }
    // The next block begins where this one has ended, so that nothing is left between them.
    for (auto c = candidates_.rbegin(); c != candidates_.rend(); ++c) {
      if (!taken_[std::size_t(c->second)]) seeds_.push_back(c->second);
      coupling_[std::size_t(c->second)] = 0;
    }
    blocks_.begin.push_back(blocks_.point.size());
  }

  void take(std::size_t p) {
    taken_[p] = 1;
    blocks_.point.push_back(Index(p));
    visit_row(p, [&](std::size_t q, float number) {
      const float strength = std::abs(number) * root_[p] * root_[q];
      if (taken_[q] || strength < least_coupling) return;
      coupling_[q] += strength;
      candidates_.emplace_back(coupling_[q], Index(q));
      std::push_heap(candidates_.begin(), candidates_.end());
    });
  }

  const SymmetricRows& matrix_;
  std::size_t most_;
  std::vector<float> root_;      // of the inverse diagonal
  std::vector<float> coupling_;  // to the block that grows
  std::vector<std::uint8_t> taken_;
  std::vector<Candidate> candidates_;
  std::vector<Index> seeds_;
  StrongBlocks blocks_;
};

}  // namespace

StrongBlocks strong_blocks(const SymmetricRows& matrix, std::size_t most) {
  return Growth(matrix, most).run();
}

}  // namespace fairing
