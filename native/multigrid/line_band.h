// SPDX-License-Identifier: GPL-3.0-or-later
// Lines of points that a matrix K couples strongly, and K's numbers along them, for the smoother
// where faces are thin. An operator writes them whenever its numbers change; the first time, lines
// are sought. Data of a point are written for that point only, so operators may write in parallel.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "base/types.h"
#include "parallel/memory.h"

namespace fairing {

// Weaker couplings do not link. A plate couples neighbours on even triangles by 0.24, along lines
// of infinitely thin faces by 2/3; by this value if triangles are a quarter higher than even ones.
constexpr float least_coupling = 0.35f;
// Least ratio to the third coupling; a smaller one is a tie, as on even quads.
constexpr float least_lead = 1.01f;

class LineBand {
 public:
  explicit LineBand(std::size_t points) : points_(points), strongest_(points) {}

  // Whether couplings are still expected.
  bool is_seeking() const { return !strongest_.empty(); }

  std::size_t lines() const { return begin_.size() - 1; }
  std::size_t length(std::size_t line) const { return begin_[line + 1] - begin_[line]; }
  const Index* points_of(std::size_t line) const { return point_.data() + begin_[line]; }

  // Seeks lines, if that has not been done; then, if there are any, sums K's numbers along them.
  // visit_numbers(wants, visit) has to call visit(p, q, K_pq) for all numbers of the rows p with
  // wants(p); each row on one thread.
  template <class VisitNumbers>
  void write(const Array<float>& inverse_diagonal, const VisitNumbers& visit_numbers) {
    if (is_seeking()) {
      Array<float> root(points_);
      for (std::size_t p = 0; p < points_; ++p) root[p] = std::sqrt(inverse_diagonal[p]);
      visit_numbers([](Index) { return true; },
                    [&](Index p, Index q, float number) {
                      if (p != q) strongest_[p].offer(q, std::abs(number) * root[p] * root[q]);
                    });
      link();
    }
    if (lines() == 0) return;
    number_.assign(3 * points_, 0.0f);
    visit_numbers([&](Index p) { return place_[p] >= 0; },
                  [&](Index p, Index q, float number) { add(p, q, number); });
  }
  // Frees the numbers after they have been read.
  void clear() { Array<float>().swap(number_); }
  // Three numbers a point: the sum of absolute values off the band, where a line turns back on
  // itself; K's number with the point before it on the line, and with the one before that.
  const Array<float>& numbers() const { return number_; }

 private:
  // Adds K_pq of a point on a line.
  void add(Index p, Index q, float number) {
    const double here = place_[p], there = place_[q];
    if (!(there >= 0 && std::floor(here / span_) == std::floor(there / span_))) return;
    if (std::abs(here - there) > 2)
      number_[3 * std::size_t(p)] += std::abs(number);
    else if (here > there)
      number_[3 * std::size_t(p) + std::size_t(here - there)] += number;
  }
  // After the last offer. Two points are linked if each is among the two that the other is coupled
  // to most strongly. So lines follow the stiff direction: across thin faces, from one to the next.
  void link();

  static constexpr Index none = -1;
  // The two strongest couplings of a point, and the third.
  struct Strongest {
    std::array<Index, 2> point = {none, none};
    std::array<float, 3> coupling = {least_coupling, least_coupling, least_coupling};
    void offer(Index q, float strength) {
      if (!(strength > coupling[2])) return;
      std::size_t k = 2;
      for (; k > 0 && strength > coupling[k - 1]; --k) {
        coupling[k] = coupling[k - 1];
        if (k < 2) point[k] = point[k - 1];
      }
      coupling[k] = strength;
      if (k < 2) point[k] = q;
    }
    // `none` if it does not exceed the third: among equal couplings numbering must not decide.
    Index outstanding(std::size_t k) const {
      return coupling[k] > least_lead * coupling[2] ? point[k] : none;
    }
    bool has(Index q) const { return outstanding(0) == q || outstanding(1) == q; }
  };

  std::size_t points_;
  Array<Strongest> strongest_;  // until they are linked
  std::vector<Index> point_;
  std::vector<std::size_t> begin_ = {0};
  // A point's place on all lines: places on one line differ by the distance in points, and lie
  // between the same multiples of the span. -1: on no line.
  double span_ = 0;
  Array<double> place_;
  Array<float> number_;
};

}  // namespace fairing
