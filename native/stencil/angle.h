// SPDX-License-Identifier: GPL-3.0-or-later
// Angles for a few multiplications: the refined surface has one at every corner of every cell. Up
// to small_turn_limit the bits do not depend on the mathematical library.
#pragma once

#include <cmath>
#include <numbers>

#include "base/simd.h"

namespace fairing {

constexpr double full_turn = 2 * std::numbers::pi;

// The series below accept numbers and packs (base/simd.h).

// Half an angle is an arctangent in [0, pi/2]: folded to [0, pi/4], turned to [-pi/8, pi/8], then a
// polynomial through Chebyshev points.
constexpr double tangent_of_eighth = 0.41421356237309503;  // of pi/8

template <class N>
DF_INLINE void half_angle_series(const N& x, N& half) {
  const N y = x * x, y2 = y * y, y4 = y2 * y2;
  const N p01 = 0.999999999999999 - 0.3333333333322143 * y,
          p23 = 0.19999999978392663 - 0.14285712661684793 * y,
          p45 = 0.11111048853751296 - 0.09089529956562307 * y,
          p67 = 0.07673535428183285 - 0.0650598296717084 * y,
          p89 = 0.05024762118940128 - 0.025316479573776477 * y;
  half = std::numbers::pi / 8 + x * ((p01 + y2 * p23) + y4 * ((p45 + y2 * p67) + y4 * p89));
}

// The angle in [0, pi] whose sine and cosine, times `length` > 0, are given (sine >= 0), to 2e-15
// (near pi to 1e-14).
inline double angle_of(double sine, double cosine, double length) {
  const double n = sine, d = length + cosine;
  const bool steep = n > d;
  const double low = steep ? d : n, high = steep ? n : d;
  double half;
  half_angle_series((low - tangent_of_eighth * high) / (high + tangent_of_eighth * low), half);
  return steep ? std::numbers::pi - 2 * half : 2 * half;
}

// Up to here, in radians, the series below are exact to rounding: the first omitted terms are
// 0.125^10 / 10! and 0.125^11 / 11!, below 3e-16.
constexpr double small_turn_limit = 0.125;

template <class N>
DF_INLINE void small_turn_series(const N& angle, N& cosine, N& sine) {
  const N y = angle * angle;
  cosine = 1.0 - y * (1.0 / 2 - y * (1.0 / 24 - y * (1.0 / 720 - y * (1.0 / 40320))));
  sine = angle * (1.0 - y * (1.0 / 6 - y * (1.0 / 120 - y * (1.0 / 5040 - y * (1.0 / 362880)))));
}

// Cosine and sine; above small_turn_limit by the library.
inline void small_turn(double angle, double& cosine, double& sine) {
  if (std::abs(angle) > small_turn_limit) {
    cosine = std::cos(angle);
    sine = std::sin(angle);
    return;
  }
  small_turn_series(angle, cosine, sine);
}

}  // namespace fairing
