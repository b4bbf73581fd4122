// SPDX-License-Identifier: GPL-3.0-or-later
#include "multigrid/chebyshev.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <cstring>
#include <utility>

#include "base/roundoff.h"
#include "base/simd.h"
#include "parallel/reductions.h"

namespace fairing {
namespace {

// One step for K x = b with the residual r = b - K x, and d the last change of x:
//
//   r -= K d,   next = momentum d + step D^-1 r,   x += next,
//
// and x += d too if that has not been added yet. D is the diagonal of K. It has one number a point,
// and is first copied to all components, a few points at a time, so that the rest uses whole packs.
struct Step {
  const float *d, *product, *inverse;  // product: K d
  float *next, *x, *r;
  float momentum, step;
  bool adds_d;
  std::size_t components;  // 1 or 3
};

constexpr std::size_t spread_points = 64;  // at a time; they stay in the L1 cache

// Lanczos comes from below, and the smoother amplifies vectors above its bound: hence the margin.
constexpr int lanczos_steps = 10;
constexpr double lanczos_margin = 1.1;  // factor of Lanczos' result

template <class T, int Bytes>
struct StepLoop {
  using P = Packs<T, Bytes>;
  using Pack = typename P::Pack;

  DF_INLINE static void run(const Step* job, std::size_t begin, std::size_t end) {
    const Step s = *job;
    const std::size_t components = s.components;
    T weight[3 * spread_points + vector_room];
    for (std::size_t first = begin; first < end; first += spread_points) {
      const std::size_t points = end - first < spread_points ? end - first : spread_points;
      if (components == 1)
        std::memcpy(weight, s.inverse + first, points * sizeof(T));
      else
        for (std::size_t p = 0; p < points; ++p)
          weight[3 * p] = weight[3 * p + 1] = weight[3 * p + 2] = s.inverse[first + p];
      const std::size_t at = components * first, size = components * points;
      const T *d = s.d + at, *product = s.product + at;
      T *next = s.next + at, *x = s.x + at, *residual = s.r + at;
      std::size_t i = 0;
      for (; i + P::size <= size; i += P::size) {
        Pack r, old, sum, w;
        P::load(residual + i, r);
        P::load(product + i, w);
        r -= w;
        P::store(r, residual + i);
        P::load(weight + i, w);
        P::load(d + i, old);
        w = s.step * w * r + s.momentum * old;
        P::load(x + i, sum);
        if (s.adds_d) sum += old;
        sum += w;
        P::store(w, next + i);
        P::store(sum, x + i);
      }
      for (; i < size; ++i) {
        residual[i] -= product[i];
        const T w = s.step * weight[i] * residual[i] + s.momentum * d[i], old = d[i];
        if (s.adds_d) x[i] += old;
        x[i] += w;
        next[i] = w;
      }
    }
  }
};

// z = step D^-1 r; copies it to `copy` unless that is null.
void divide_by_diagonal(const LevelOperator& op, Workers& workers, float step, const float* r,
                        float* z, float* copy) {
  const std::size_t components = op.components();
  const float* inverse = op.inverse_diagonal().data();
  workers.for_parts(op.points(), vector_grain / 4, [&](std::size_t begin, std::size_t end) {
    for (std::size_t p = begin, i = components * begin; p < end; ++p)
      for (std::size_t a = 0; a < components; ++a, ++i) z[i] = step * inverse[p] * r[i];
    if (copy) std::copy(z + components * begin, z + components * end, copy + components * begin);
  });
}

}  // namespace

void smooth(LevelOperator& op, const LineJacobi* lines, Workers& workers, double largest_eigenvalue,
            int degree, SmoothFrom from, bool last_residual, SmootherState& s) {
  const auto first_step = float(4.0 / 3.0 / largest_eigenvalue);
  const auto take_step = [&](float momentum, float step, bool adds_d) {
    op.apply(s.step.data(), s.next.data());
    const Step now{.d = s.step.data(),
                   .product = s.next.data(),
                   .inverse = op.inverse_diagonal().data(),
                   .next = s.next.data(),
                   .x = s.x.data(),
                   .r = s.residual.data(),
                   .momentum = momentum,
                   .step = step,
                   .adds_d = adds_d,
                   .components = op.components()};
    workers.for_parts(op.points(), vector_grain / 4, [&](std::size_t begin, std::size_t end) {
      run_loop<StepLoop, float>(&now, begin, end);
    });
    if (lines) lines->add(step, now.r, now.x, now.next);
    std::swap(s.step, s.next);
  };
  if (from == SmoothFrom::zero) {
    divide_by_diagonal(op, workers, first_step, s.residual.data(), s.x.data(), s.step.data());
    if (lines) lines->add(first_step, s.residual.data(), s.x.data(), s.step.data());
  } else {
    take_step(0, first_step, true);
  }
  for (int k = 1; k < degree; ++k)
    take_step(float((2.0 * k - 1) / (2.0 * k + 3)),
              float((8.0 * k + 4) / (2.0 * k + 3) / largest_eigenvalue), false);
  if (!last_residual) return;
  op.apply(s.step.data(), s.next.data());
  for_each_index(workers, op.size(), [&](std::size_t i) { s.residual[i] -= s.next[i]; });
}

double largest_eigenvalue(LevelOperator& op, const LineJacobi* lines, Workers& workers,
                          const float* start) {
  const std::size_t size = op.size();
  // Lanczos in the scalar product of B^-1, the diagonal with the lines: (v_i, z_j) = (i = j), z =
  // B^-1 v.
  Array<float> v(size), before(size, 0.0f), z(size + vector_room), product(size);
  const auto length = [&](const Array<float>& r) {
    divide_by_diagonal(op, workers, 1, r.data(), z.data(), nullptr);
    if (lines) lines->add(1, r.data(), z.data(), nullptr);
    return std::sqrt(std::max(
        sum(workers, size, [&](std::size_t i) { return double(r[i]) * double(z[i]); }), 0.0));
  };
  for_each_index(workers, size, [&](std::size_t i) { v[i] = start[i]; });
  double beta = length(v);
  if (!(beta > 0) || !std::isfinite(beta)) return 4.0;  // nothing to solve; any safe value
  const auto scale = [&](double by) {
    for_each_index(workers, size, [&](std::size_t i) {
      v[i] = float(v[i] / by);
      z[i] = float(z[i] / by);
    });
  };
  scale(beta);
  beta = 0;
  Eigen::VectorXd diagonal(lanczos_steps), off(lanczos_steps);
  int m = 0;
  for (; m < lanczos_steps; ++m) {
    op.apply(z.data(), product.data());
    const double alpha =
        sum(workers, size, [&](std::size_t i) { return double(product[i]) * z[i]; });
    diagonal(m) = alpha;
    for_each_index(workers, size, [&](std::size_t i) {
      product[i] = float(product[i] - alpha * v[i] - beta * before[i]);
    });
    beta = length(product);
    off(m) = beta;
    if (!(beta > single_roundoff * alpha)) {  // the rest is rounding
      ++m;
      break;
    }
    std::swap(before, v);
    std::swap(v, product);
    scale(beta);
  }
  Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen;
  eigen.computeFromTridiagonal(diagonal.head(m), off.head(m > 1 ? m - 1 : 0),
                               Eigen::EigenvaluesOnly);
  return lanczos_margin * eigen.eigenvalues().maxCoeff();
}

}  // namespace fairing
