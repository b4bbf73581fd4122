// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/chebyshev.h"

#include <cstring>
#include <utility>

#include "execution/vectors.h"
#include "execution/wide.h"

namespace fairing {
namespace {

// A block of points. The diagonal, one number a point, is spread to all components first, a few points at a time: the
// rest then runs on whole packs.
struct StepJob {
  SmoothingStep step;
  const float *inverse, *image;
  std::size_t components;  // 1 or 3
};

constexpr std::size_t spread_points = 64;

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
      const T *d = s.d + at, *image = job->image + at;
      T *next = s.next + at, *x = s.x + at, *residual = s.r + at;
      std::size_t i = 0;
      for (; i + P::size <= size; i += P::size) {
        Pack r, old, sum, w;
        P::load(residual + i, r);
        P::load(image + i, w);
        r -= w;
        P::store(r, residual + i);
        P::load(weight + i, w);
        P::load(d + i, old);
        w = s.gain * w * r + s.carry * old;
        P::load(x + i, sum);
        if (s.adds_d) sum += old;
        sum += w;
        P::store(w, next + i);
        P::store(sum, x + i);
      }
      for (; i < size; ++i) {
        residual[i] -= image[i];
        const T w = s.gain * weight[i] * residual[i] + s.carry * d[i], old = d[i];
        if (s.adds_d) x[i] += old;
        x[i] += w;
        next[i] = w;
      }
    }
  }
};

// x = d = gain D^-1 r
void start_from_zero(const LevelOperator& op, Workers& workers, float gain, SmootherState& s) {
  const std::size_t components = op.components();
  const float* inverse = op.inverse_diagonal().data();
  workers.for_parts(op.points(), vector_grain / 4, [&](std::size_t begin, std::size_t end) {
    const float* r = s.residual.data() + components * begin;
    float *x = s.x.data() + components * begin, *d = s.step.data() + components * begin;
    for (std::size_t p = begin; p < end; ++p)
      for (std::size_t a = 0; a < components; ++a) *x++ = *d++ = gain * inverse[p] * *r++;
  });
}

}  // namespace

void finish_step(const SmoothingStep& step, std::size_t components, const float* inverse_diagonal,
                 std::size_t first, std::size_t count, const float* image) {
  const std::size_t at = components * first;
  const StepJob job{
      {step.d + at, step.next + at, step.x + at, step.r + at, step.carry, step.gain, step.adds_d},
      inverse_diagonal + first,
      image,
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

void LevelOperator::subtract_image(const float* x, float* room, float* y, Workers& workers) {
  apply(x, room);
  for_each_index(workers, size(), [=](std::size_t i) { y[i] -= room[i]; });
}

void smooth(LevelOperator& op, Workers& workers, double largest_eigenvalue, int degree, SmoothFrom from,
            bool last_residual, SmootherState& s) {
  const auto first_gain = float(4.0 / 3.0 / largest_eigenvalue);
  const auto relax = [&](float carry, float gain, bool adds_d) {
    op.relax({s.step.data(), s.next.data(), s.x.data(), s.residual.data(), carry, gain, adds_d}, workers);
    std::swap(s.step, s.next);
  };
  if (from == SmoothFrom::zero)
    start_from_zero(op, workers, first_gain, s);
  else
    relax(0, first_gain, true);
  for (int k = 1; k < degree; ++k)
    relax(float((2.0 * k - 1) / (2.0 * k + 3)), float((8.0 * k + 4) / (2.0 * k + 3) / largest_eigenvalue),
          false);
  if (last_residual) op.subtract_image(s.step.data(), s.next.data(), s.residual.data(), workers);
}

}  // namespace fairing
