// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/chebyshev.h"

#include <cstring>

#include "execution/vectors.h"
#include "execution/wide.h"

namespace fairing {
namespace {

// One pass over the vectors: r -= image, d = carry d + gain D^-1 r, x += d; without `image` r stays, without `add` x
// is set. The diagonal, one number a point, is spread to all components first, a few points at a time: the rest then
// runs on whole packs.
struct Step {
  const float *inverse, *image;
  float *x, *r, *d;
  float carry, gain;
  bool add;
  std::size_t components;  // 1 or 3
};

constexpr std::size_t spread_points = 64;

template <class T, int Bytes>
struct StepLoop {
  using P = Packs<T, Bytes>;
  using Pack = typename P::Pack;

  DF_INLINE static void run(const Step* step, std::size_t begin, std::size_t end) {
    const Step s = *step;
    T weight[3 * spread_points + lane_room];
    for (std::size_t first = begin; first < end; first += spread_points) {
      const std::size_t count = end - first < spread_points ? end - first : spread_points;
      if (s.components == 1)
        std::memcpy(weight, s.inverse + first, count * sizeof(T));
      else
        for (std::size_t p = 0; p < count; ++p)
          weight[3 * p] = weight[3 * p + 1] = weight[3 * p + 2] = s.inverse[first + p];
      const std::size_t at = s.components * first, size = s.components * count;
      std::size_t i = 0;
      for (; i + P::size <= size; i += P::size) {
        Pack r, d, x, w;
        P::load(s.r + at + i, r);
        P::load(weight + i, w);
        if (s.image) {
          Pack image;
          P::load(s.image + at + i, image);
          r -= image;
          P::store(r, s.r + at + i);
        }
        w = s.gain * w * r;
        if (s.carry != 0) {
          P::load(s.d + at + i, d);
          w += s.carry * d;
        }
        P::store(w, s.d + at + i);
        if (s.add) {
          P::load(s.x + at + i, x);
          w += x;
        }
        P::store(w, s.x + at + i);
      }
      for (; i < size; ++i) {
        const std::size_t k = at + i;
        if (s.image) s.r[k] -= s.image[k];
        const T gained = s.gain * weight[i] * s.r[k];
        s.d[k] = s.carry != 0 ? gained + s.carry * s.d[k] : gained;
        s.x[k] = s.add ? s.d[k] + s.x[k] : s.d[k];
      }
    }
  }

 private:
  static constexpr std::size_t lane_room = 16;
};

}  // namespace

void smooth(LevelOperator& op, Workers& workers, double largest_eigenvalue, int degree, bool from_zero,
            bool last_residual, SmootherState& s) {
  const std::size_t points = op.points();
  Step step{
      op.inverse_diagonal().data(),          nullptr,    s.x.data(),     s.residual.data(), s.step.data(), 0,
      float(4.0 / 3.0 / largest_eigenvalue), !from_zero, op.components()};
  const auto advance = [&] {
    workers.for_parts(points, vector_grain / 4, [&](std::size_t begin, std::size_t end) {
      run_loop<StepLoop, float>(static_cast<const Step*>(&step), begin, end);
    });
  };
  advance();
  step.image = s.image.data();
  step.add = true;
  for (int k = 1; k < degree; ++k) {
    op.apply(s.step.data(), s.image.data());
    step.carry = float((2.0 * k - 1) / (2.0 * k + 3));
    step.gain = float((8.0 * k + 4) / (2.0 * k + 3) / largest_eigenvalue);
    advance();
  }
  if (!last_residual) return;
  op.apply(s.step.data(), s.image.data());
  float* r = s.residual.data();
  const float* image = s.image.data();
  for_each_index(workers, op.size(), [=](std::size_t i) { r[i] -= image[i]; });
}

}  // namespace fairing
