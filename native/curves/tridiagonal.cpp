// SPDX-License-Identifier: GPL-3.0-or-later
#include "curves/tridiagonal.h"

namespace fairing {
namespace {

template <class Value>
void solve_open(std::vector<double> diagonal, const std::vector<double>& right,
                std::vector<Value>& value) {
  const std::size_t n = value.size();
  for (std::size_t i = 1; i < n; ++i) {
    const double factor = right[i - 1] / diagonal[i - 1];
    diagonal[i] -= factor * right[i - 1];
    value[i] -= factor * value[i - 1];
  }
  for (std::size_t i = n; i-- > 0;) {
    if (i + 1 < n) value[i] -= right[i] * value[i + 1];
    value[i] /= diagonal[i];
  }
}

}  // namespace

std::vector<Vec3> solve_tridiagonal(const std::vector<double>& diagonal,
                                    const std::vector<double>& right, std::vector<Vec3> value,
                                    bool cyclic) {
  if (!cyclic) {
    solve_open(diagonal, right, value);
    return value;
  }
  // Sherman–Morrison: the matrix is an open one, T, plus c w wᵀ with w = e_first + e_last.
  const double c = right.back();
  std::vector<double> open = diagonal;
  open.front() -= c;
  open.back() -= c;
  std::vector<double> w(value.size(), 0.0);
  w.front() = w.back() = 1;
  solve_open(open, right, value);
  solve_open(open, right, w);
  const Vec3 factor = (c / (1 + c * (w.front() + w.back()))) * (value.front() + value.back());
  for (std::size_t i = 0; i < value.size(); ++i) value[i] -= w[i] * factor;
  return value;
}

}  // namespace fairing
