// SPDX-License-Identifier: GPL-3.0-or-later
// Lines of points that a matrix K couples strongly, and K's numbers along them, for the smoother
// where faces are thin. An operator first offers its couplings, once; then it adds its numbers,
// whenever they change. Data of a point are written for that point only, so operators may write in
// parallel.
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
  // The coupling of p to q: |K_pq| over the root of K_pp K_qq.
  void offer(Index p, Index q, float coupling) { strongest_[p].offer(q, coupling); }

  std::size_t lines() const { return begin_.size() - 1; }
  std::size_t length(std::size_t line) const { return begin_[line + 1] - begin_[line]; }
  const Index* points_of(std::size_t line) const { return point_.data() + begin_[line]; }

  // An operator's use of a band: offer() makes all offers while they are expected; then add() adds
  // all numbers if there are lines.
  template <class Offer, class Add>
  void write(const Offer& offer, const Add& add) {
    if (is_seeking()) {
      offer();
      link();
    }
    if (lines() == 0) return;
    number_.assign(3 * points_, 0.0f);
    add();
  }
  // Frees the numbers after they have been read.
  void clear() { Array<float>().swap(number_); }
  // A point's place on all lines: places on one line differ by the distance in points; -1: on no
  // line. One number a point.
  const Array<double>& places() const { return place_; }
  // Whether two places are on one line.
  bool are_on_one(double place_p, double place_q) const {
    return place_p >= 0 && place_q >= 0 && std::abs(place_p - place_q) < span_ &&
           std::floor(place_p / span_) == std::floor(place_q / span_);
  }
  // For a part of K_pq = K_qp and the places of both points, on one line: calls visit(whether it is
  // for q, which of numbers(), part).
  template <class Visit>
  void visit_pair(double place_p, double place_q, float number, Visit&& visit) const {
    const double apart = place_q - place_p;
    if (std::abs(apart) > 2) {
      visit(true, 0, std::abs(number));
      visit(false, 0, std::abs(number));
    } else if (apart != 0) {
      visit(apart > 0, int(std::abs(apart)), number);
    }
  }
  // Adds K_pq of row p; K_qp has to be added as well.
  void add(Index p, Index q, float number) {
    const double here = place_[p], there = place_[q];
    if (are_on_one(here, there))
      visit_pair(here, there, number, [&](bool to_q, int beside, float part) {
        if (!to_q) number_[3 * std::size_t(p) + std::size_t(beside)] += part;
      });
  }
  // Three numbers a point: the sum of absolute values off the band, where a line turns back on
  // itself; K's number with the point before it on the line, and with the one before that.
  Array<float>& numbers() { return number_; }
  const Array<float>& numbers() const { return number_; }

 private:
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
  double span_ = 0;
  Array<double> place_;
  Array<float> number_;
};

}  // namespace fairing
