// SPDX-License-Identifier: GPL-3.0-or-later
// Random numbers that are the same with every C++ library: the standard fixes the engines, but not
// the distributions. These are those of GNU's library, to the bit.
#pragma once

#include <cmath>
#include <limits>
#include <random>

namespace fairing::test {

// A number from 0 to below 1.
template <class T>
T canonical(std::mt19937& random) {
  constexpr T range = T(4294967296.0);
  T sum = T(random()), size = range;
  if constexpr (std::numeric_limits<T>::digits > 32) {
    sum += T(random()) * size;
    size *= range;
  }
  const T found = sum / size;
  return found < T(1) ? found : std::nextafter(T(1), T(0));
}

template <class T = double>
class UniformReal {
 public:
  UniformReal(T from, T to) : from_(from), to_(to) {}
  T operator()(std::mt19937& random) const { return canonical<T>(random) * (to_ - from_) + from_; }

 private:
  T from_, to_;
};

template <class T = double>
class Normal {
 public:
  explicit Normal(T mean = 0, T deviation = 1) : mean_(mean), deviation_(deviation) {}
  T operator()(std::mt19937& random) {
    if (has_saved_) {
      has_saved_ = false;
      return saved_ * deviation_ + mean_;
    }
    T x, y, square;
    do {
      x = T(2) * canonical<T>(random) - T(1);
      y = T(2) * canonical<T>(random) - T(1);
      square = x * x + y * y;
    } while (square > T(1) || square == T(0));
    const T scale = std::sqrt(-2 * std::log(square) / square);
    saved_ = x * scale;
    has_saved_ = true;
    return y * scale * deviation_ + mean_;
  }

 private:
  T mean_, deviation_, saved_ = 0;
  bool has_saved_ = false;
};

}  // namespace fairing::test
