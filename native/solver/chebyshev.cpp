// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/chebyshev.h"

#include "execution/vectors.h"

namespace fairing {

void smooth(LevelOperator& op, Workers& workers, double largest_eigenvalue, int degree, bool from_zero,
            bool last_residual, SmootherState& s) {
  const std::size_t points = op.points();
  const float* inverse = op.inverse_diagonal().data();
  float *x = s.x.data(), *r = s.residual.data(), *d = s.step.data(), *image = s.image.data();

  const auto each_point = [&](auto&& body) {
    workers.for_parts(points, vector_grain / 4, [&](std::size_t begin, std::size_t end) {
      for (std::size_t p = begin; p < end; ++p)
        for (std::size_t i = 3 * p; i < 3 * p + 3; ++i) body(i, inverse[p]);
    });
  };

  const float first = float(4.0 / 3.0 / largest_eigenvalue);
  if (from_zero)
    each_point([&](std::size_t i, float w) { x[i] = d[i] = first * w * r[i]; });
  else
    each_point([&](std::size_t i, float w) { x[i] += d[i] = first * w * r[i]; });
  for (int k = 1; k < degree; ++k) {
    op.apply(d, image);
    const float carry = float((2.0 * k - 1) / (2.0 * k + 3)),
                gain = float((8.0 * k + 4) / (2.0 * k + 3) / largest_eigenvalue);
    each_point([&](std::size_t i, float w) {
      r[i] -= image[i];
      d[i] = carry * d[i] + gain * w * r[i];
      x[i] += d[i];
    });
  }
  if (!last_residual) return;
  op.apply(d, image);
  each_point([&](std::size_t i, float) { r[i] -= image[i]; });
}

}  // namespace fairing
