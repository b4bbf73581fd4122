// SPDX-License-Identifier: GPL-3.0-or-later
#include "curvature/curvature_lanes.h"

#include <numbers>

#include "curvature/ring_fan.h"
#include "stencil/whitened_fit.h"

namespace fairing {
namespace {

// Does for several points with regular rings, one in each lane, what point_curvature() and
// linearize() do for one.
template <class T, int Bytes>
struct ShapeLoop {
  using P = Packs<T, Bytes>;
  using Pack = typename P::Pack;
  using Mask = typename P::Mask;
  using Fan = RingFan<Pack, T>;
  using Vector = typename Fan::Vector;
  using Fit = WhitenedFit<Pack, T>;

  DF_INLINE static void put(const Mask& where, const Pack& value, T* to) {
    const Pack zero = {};
    P::store(where ? value : zero, to);
  }

  DF_INLINE static void load(const RunRings& run, std::size_t first, Fan& fan, Mask& done) {
    Vector centre;
    P::load(run.at[0][0] + first, centre.x);
    P::load(run.at[0][1] + first, centre.y);
    P::load(run.at[0][2] + first, centre.z);
    for (int j = 0; j < run.size; ++j) {
      Vector& p = fan.at[j].p;
      P::load(run.at[j + 1][0] + first, p.x);
      P::load(run.at[j + 1][1] + first, p.y);
      P::load(run.at[j + 1][2] + first, p.z);
      p.x -= centre.x, p.y -= centre.y, p.z -= centre.z;
      Fan::measure(fan.at[j], done);
    }
  }

  DF_INLINE static void lift(const RunRings& run, std::size_t first, Fan& fan) {
    Pack own;
    P::widen(run.lift[0] + first, own);
    fan.lift([&](int j, Pack& share) __attribute__((always_inline)) {
      P::widen(run.lift[j + 1] + first, share);
      share = share > own ? share : own;
    });
  }

  // The ring in the form that the fit reads.
  struct Neighbours {
    const Fan& fan;
    DF_INLINE void operator()(int j, Pack& u, Pack& v, Pack& weight) const {
      const auto& n = fan.at[j];
      u = n.radius * n.turn.cosine;
      v = n.radius * n.turn.sine;
      weight = n.weight;
    }
  };
  // sum += the terms of neighbour j, times its weight and `height`.
  DF_INLINE static void add(const Fit& fit, const Fan& fan, int j, const Pack& height,
                            typename Fit::Term& sum) {
    Pack u, v, weight;
    Neighbours{fan}(j, u, v, weight);
    fit.add(u, v, weight * height, sum);
  }

  DF_INLINE static void put_rows(const Fan& fan, const Fit& fit, CurvatureEnergy energy,
                                 const Pack& trace, const Pack& area, const Pack& a, const Pack& b,
                                 const Mask& done, CurvatureLanes& out, int lane) {
    Pack rows[8][5], round[2] = {};
    for (int j = 0; j < fan.size; ++j) {
      typename Fit::Term sum = {};
      add(fit, fan, j, Pack{} + T(1), sum);
      fit.solve(sum, rows[j]);
      round[0] += fan.at[j].square * rows[j][3];
      round[1] += fan.at[j].square * rows[j][4];
    }
    const Pack scale = T(root_half) / area, square = a * a + b * b;
    round[0] *= T(0.5 * root_half);
    round[1] *= T(0.5 * root_half);
    Pack own[3];
    own_term(energy, trace, a, b, square, own[0], own[1], own[2]);
    for (int j = 0; j < fan.size; ++j) {
      const Pack first = scale * fan.at[j].cotangent;
      const Pack second = rows[j][3] - first * round[0], third = rows[j][4] - first * round[1];
      own[0] -= first;
      own[1] -= second;
      own[2] -= third;
      put(done, first, out.row[j + 1][0] + lane);
      put(done, second, out.row[j + 1][1] + lane);
      put(done, third, out.row[j + 1][2] + lane);
      put(done, fan.at[j].cotangent, out.cotangent[j + 1] + lane);
    }
    for (int c = 0; c < 3; ++c) put(done, own[c], out.row[0][c] + lane);
    put(done, Pack{}, out.cotangent[0] + lane);
  }

  DF_INLINE static void run(const RunRings* rings, std::size_t begin, CurvatureEnergy energy,
                            bool wants_axis, CurvatureLanes* out) {
    for (int lane = 0; lane < lane_count; lane += P::size) {
      const std::size_t first = begin + std::size_t(lane);
      typename Fan::Neighbour ring[8];
      Fan fan{ring, rings->size};
      const std::uint8_t* const far = rings->far + 1;
      Mask done = Pack{} == Pack{};
      load(*rings, first, fan, done);
      fan.template sum_up<true>(far, true, done);
      if (rings->lift[0]) lift(*rings, first, fan);
      fan.normalize(done);
      fan.lay_out(fan.total, far, done);

      done &= fan.circumcentric >= T(least_area_share) * fan.barycentric;
      const Vector& normal = fan.normal;
      const Pack& area = fan.circumcentric;
      Pack trace;
      Fan::dot(normal, fan.laplacian, trace);
      trace = trace / area;
      Fit fit;
      fit.make(fan.size, Neighbours{fan}, done);
      typename Fit::Term sum = {};
      for (int j = 0; j < fan.size; ++j) {
        Pack height;
        Fan::dot(normal, fan.at[j].p, height);
        add(fit, fan, j, height - T(0.25) * trace * fan.at[j].square, sum);
      }
      Pack coefficient[5];
      fit.solve(sum, coefficient);
      const Pack &a = coefficient[3], &b = coefficient[4];
      done &= a * a + b * b < T(1e300);

      put(done, normal.x, out->normal[0] + lane);
      put(done, normal.y, out->normal[1] + lane);
      put(done, normal.z, out->normal[2] + lane);
      put(done, T(root_half) * trace, out->shape[0] + lane);
      put(done, a, out->shape[1] + lane);
      put(done, b, out->shape[2] + lane);
      put(done, area, out->area + lane);
      for (int l = 0; l < P::size; ++l) out->done[lane + l] = done[l] != 0;
      if (wants_axis) {
        Vector axis;
        fan.find_axis(axis);
        put(done, axis.x, out->axis[0] + lane);
        put(done, axis.y, out->axis[1] + lane);
        put(done, axis.z, out->axis[2] + lane);
      }
      put_rows(fan, fit, energy, trace, area, a, b, done, *out, lane);
    }
  }
};

}  // namespace

void linearize(const RunRings& run, std::size_t first, CurvatureEnergy energy, bool wants_axis,
               CurvatureLanes& out) {
  run_loop<ShapeLoop, double>(&run, first, energy, wants_axis, &out);
}

}  // namespace fairing
