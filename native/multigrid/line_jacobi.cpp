// SPDX-License-Identifier: GPL-3.0-or-later
#include "multigrid/line_jacobi.h"

#include <algorithm>
#include <numeric>

#include "base/roundoff.h"
#include "base/simd.h"

namespace fairing {
namespace {

using Bundle = LineJacobi::Bundle;
constexpr std::size_t lanes = LineJacobi::lanes;

struct LineJob {
  const Bundle* bundle;
  float step;
  const float* r;
  float *x, *change;  // `change` may be null
  float* room;        // components * points
};

// L z = r forwards, then L^T y = D^-1 z backwards, on `lanes` lines at a time.
template <int C>
struct LineLoop {
  template <class T, int Bytes>
  struct Of {
    using P = Packs<float, sizeof(float) * lanes>;
    using Pack = typename P::Pack;

    DF_INLINE static void run(const LineJob* job) {
      const Bundle& b = *job->bundle;
      const std::size_t size = b.point.size();
      const Index* point = b.point.data();
      Pack one[C] = {}, two[C] = {};
      for (std::size_t k = 0; k < size; k += lanes) {
        Pack before, further;
        P::load(b.before.data() + k, before);
        P::load(b.further.data() + k, further);
        for (int a = 0; a < C; ++a) {
          Pack now;
          for (std::size_t l = 0; l < lanes; ++l)
            now[l] = job->r[C * std::size_t(point[k + l]) + std::size_t(a)];
          now = now - before * one[a] - further * two[a];
          two[a] = one[a];
          one[a] = now;
          P::store(now, job->room + C * k + std::size_t(a) * lanes);
        }
      }
      Pack later[C] = {}, next[C] = {}, last[C] = {};
      for (std::size_t k = size; k > 0;) {
        k -= lanes;
        Pack before, further, inverse, diagonal;
        P::load(b.before.data() + k, before);
        P::load(b.further.data() + k, further);
        P::load(b.inverse.data() + k, inverse);
        P::load(b.diagonal.data() + k, diagonal);
        for (int a = 0; a < C; ++a) {
          Pack now, load;
          P::load(job->room + C * k + std::size_t(a) * lanes, now);
          for (std::size_t l = 0; l < lanes; ++l)
            load[l] = job->r[C * std::size_t(point[k + l]) + std::size_t(a)];
          now = now * inverse - next[a] - last[a];
          last[a] = later[a];
          next[a] = before * now;
          later[a] = further * now;
          now = job->step * (now - diagonal * load);
          for (std::size_t l = 0; l < lanes; ++l) {
            const std::size_t at = C * std::size_t(point[k + l]) + std::size_t(a);
            job->x[at] += now[l];
            if (job->change) job->change[at] += now[l];
          }
        }
      }
    }
  };
};

}  // namespace

LineJacobi::LineJacobi(LevelOperator& op, Workers& workers)
    : op_(op), workers_(workers), band_(op.points()) {
  op.write_lines(band_, workers);
  serves_ = !band_.is_seeking() && band_.lines() > 0;
  if (serves_) {
    bundle_lines();
    factor();
  } else {
    band_ = LineBand(0);
  }
}

// Groups lines of equal length.
void LineJacobi::bundle_lines() {
  order_.resize(band_.lines());
  std::iota(order_.begin(), order_.end(), std::size_t(0));
  std::stable_sort(order_.begin(), order_.end(),
                   [&](std::size_t a, std::size_t b) { return band_.length(a) > band_.length(b); });
  for (std::size_t k = 0; k < order_.size(); k += lanes) {
    Bundle& bundle = bundle_.emplace_back();
    const std::size_t longest = band_.length(order_[k]);
    bundle.point.assign(lanes * longest, band_.points_of(order_[k])[0]);
    for (std::size_t l = 0; l < lanes && k + l < order_.size(); ++l)
      for (std::size_t i = 0; i < band_.length(order_[k + l]); ++i)
        bundle.point[lanes * i + l] = band_.points_of(order_[k + l])[i];
    for (auto* v : {&bundle.inverse, &bundle.diagonal, &bundle.before, &bundle.further})
      v->assign(bundle.point.size(), 0.0f);
    bytes_ += bundle.point.size() * (sizeof(Index) + 4 * sizeof(float));
  }
  MemoryLedger::add(bytes_);
}

void LineJacobi::refactor() {
  if (!any()) return;
  op_.write_lines(band_, workers_);
  serves_ = !band_.numbers().empty();
  if (serves_) factor();
}

void LineJacobi::factor() {
  workers_.for_each(bundle_.size(), 1, [&](std::size_t b) {
    for (std::size_t l = 0; l < lanes && lanes * b + l < order_.size(); ++l)
      factor_line(order_[lanes * b + l], bundle_[b], l);
  });
  band_.clear();
}

// L D L^T. Entries outside the band are added to the diagonal, so that B is at least K on the line.
// If rounding leaves no pivot, another line begins.
void LineJacobi::factor_line(std::size_t line, Bundle& b, std::size_t lane) const {
  const Array<float>& inverse = op_.inverse_diagonal();
  // one and two rows before; L's number one row before
  double pivot = 0, last_pivot = 0, last_before = 0;
  for (std::size_t i = 0; i < band_.length(line); ++i) {
    const std::size_t at = lanes * i + lane;
    const auto p = std::size_t(band_.points_of(line)[i]);
    const float* number = band_.numbers().data() + 3 * p;
    const double d = 1 / double(inverse[p]);
    double further = last_pivot > 0 ? double(number[2]) / last_pivot : 0.0;
    const double beside = i > 0 ? number[1] - further * last_pivot * last_before : 0.0;
    double before = pivot > 0 ? beside / pivot : 0.0;
    double now = d + number[0] - further * further * last_pivot - before * before * pivot;
    last_pivot = pivot;
    if (!(now > single_roundoff * d)) {
      now = d;
      before = further = last_pivot = 0;
    }
    b.inverse[at] = float(1 / now);
    b.diagonal[at] = inverse[p];
    b.before[at] = float(before);
    b.further[at] = float(further);
    pivot = now;
    last_before = before;
  }
}

void LineJacobi::add(float step, const float* r, float* x, float* change) const {
  if (!serves_) return;
  const std::size_t components = op_.components();
  workers_.for_each(bundle_.size(), 1, [&](std::size_t b) {
    const LineJob job{
        &bundle_[b], step,
        r,           x,
        change,      room_in(thread_scratch<float>().work, components * bundle_[b].point.size())};
    if (components == 3)
      run_loop<LineLoop<3>::template Of, float>(&job);
    else
      run_loop<LineLoop<1>::template Of, float>(&job);
  });
}

}  // namespace fairing
