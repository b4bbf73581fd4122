// SPDX-License-Identifier: GPL-3.0-or-later
#include "multigrid/chebyshev.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <cstring>
#include <utility>

#include "base/simd.h"
#include "parallel/reductions.h"

namespace fairing {
namespace {

// A block of points. The diagonal, one number a point, is first copied to all components, a few
// points at a time, so that the rest uses whole packs.
struct StepJob {
  SmoothingStep step;
  const float *inverse, *product;
  std::size_t components;  // 1 or 3
};

constexpr std::size_t spread_points = 64;  // at a time; they stay in the L1 cache

// Lanczos comes from below, and the smoother amplifies vectors above its bound: hence the margin.
constexpr int lanczos_steps = 10;
constexpr double lanczos_margin = 1.1;  // factor of Lanczos' result
// If the next Lanczos vector is this small, relative to the eigenvalue, the rest is rounding.
constexpr double lanczos_end = 1e-5;

template <class T, int Bytes>
struct StepLoop {
  using P = Packs<T, Bytes>;
  using Pack = typename P::Pack;

  DF_INLINE static void run(const StepJob* job, std::size_t count) {
    const SmoothingStep s = job->step;
    const std::size_t components = job->components;
    T weight[3 * spread_points + vector_room];
    for (std::size_t first = 0; first < count; first += spread_points) {
      const std::size_t points = count - first < spread_points ? count - first : spread_points;
      if (components == 1)
        std::memcpy(weight, job->inverse + first, points * sizeof(T));
      else
        for (std::size_t p = 0; p < points; ++p)
          weight[3 * p] = weight[3 * p + 1] = weight[3 * p + 2] = job->inverse[first + p];
      const std::size_t at = components * first, size = components * points;
      const T *d = s.d + at, *product = job->product + at;
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

void finish_step(const SmoothingStep& step, std::size_t components, const float* inverse_diagonal,
                 std::size_t first, std::size_t count, const float* product) {
  const std::size_t at = components * first;
  const StepJob job{{step.d + at, step.next + at, step.x + at, step.r + at, step.momentum,
                     step.step, step.adds_d},
                    inverse_diagonal + first,
                    product,
                    components};
  run_loop<StepLoop, float>(&job, count);
}

void LevelOperator::relax(const SmoothingStep& step, Workers& workers) {
  apply(step.d, step.next);
  workers.for_parts(points(), vector_grain / 4, [&](std::size_t begin, std::size_t end) {
    finish_step(step, components(), inverse_diagonal().data(), begin, end - begin,
                step.next + components() * begin);
  });
}

void LevelOperator::subtract_product(const float* x, float* room, float* y, Workers& workers) {
  apply(x, room);
  for_each_index(workers, size(), [=](std::size_t i) { y[i] -= room[i]; });
}

void smooth(LevelOperator& op, const LineJacobi* lines, Workers& workers, double largest_eigenvalue,
            int degree, SmoothFrom from, bool last_residual, SmootherState& s) {
  const auto first_step = float(4.0 / 3.0 / largest_eigenvalue);
  const auto relax = [&](float momentum, float step, bool adds_d) {
    const SmoothingStep now{s.step.data(), s.next.data(), s.x.data(), s.residual.data(),
                            momentum,      step,          adds_d};
    op.relax(now, workers);
    if (lines) lines->add(step, now.r, now.x, now.next);
    std::swap(s.step, s.next);
  };
  if (from == SmoothFrom::zero) {
    divide_by_diagonal(op, workers, first_step, s.residual.data(), s.x.data(), s.step.data());
    if (lines) lines->add(first_step, s.residual.data(), s.x.data(), s.step.data());
  } else {
    relax(0, first_step, true);
  }
  for (int k = 1; k < degree; ++k)
    relax(float((2.0 * k - 1) / (2.0 * k + 3)),
          float((8.0 * k + 4) / (2.0 * k + 3) / largest_eigenvalue), false);
  if (last_residual) op.subtract_product(s.step.data(), s.next.data(), s.residual.data(), workers);
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
    if (!(beta > lanczos_end * alpha)) {
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
