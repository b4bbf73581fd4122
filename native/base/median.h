// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cstddef>

namespace fairing {

// Standard deviation of a normal distribution over the median of its absolute values.
constexpr double deviation_over_median = 1.4826022185056018;

// The median, of an even number the mean of the middle two; 0 for none. Reorders the values.
template <class Values>
double median(Values&& values) {
  if (values.empty()) return 0;
  const auto middle = values.begin() + values.size() / 2;
  std::nth_element(values.begin(), middle, values.end());
  if (values.size() % 2 == 1) return double(*middle);
  return 0.5 * (double(*middle) + double(*std::max_element(values.begin(), middle)));
}

}  // namespace fairing
