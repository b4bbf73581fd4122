// SPDX-License-Identifier: GPL-3.0-or-later
#include "curvature/curvature_lanes.h"

#include <numbers>

#include "base/simd.h"
#include "stencil/angle.h"
#include "stencil/round_fit.h"

namespace fairing {
namespace {

// What point_curvature() and linearize() do for one point with a regular ring, lane by lane. The
// angles' series (stencil/angle.h), the fit (stencil/round_fit.h) and the point's own term are the
// same code for both. The rest is not, for the two round differently, and either's bits would
// change: a point alone divides by lengths and areas where lanes multiply by reciprocals, adds the
// coordinates of a product in another order (Eigen's), and takes polar coordinates back to radii.
// It also takes ways that lanes leave to it: rings of any valence, open ones, triangles without an
// area, and areas below their floor.
template <class T, int Bytes>
struct ShapeLoop {
  using P = Packs<T, Bytes>;
  using Pack = typename P::Pack;
  using Mask = typename P::Mask;

  struct Vector {
    Pack x, y, z;
  };
  struct Turn {
    Pack cosine, sine;
  };

  // A ring in space and its chart.
  struct Ring {
    Vector p[8];                         // offsets
    Pack square[8], radius[8];           // of them
    Pack inverse[8], inverse_radius[8];  // reciprocals
    Turn turn[8];                        // directions in the chart
    Pack cotangent[8], weight[8];
    Pack angle[8];
  };
  // Sums over the triangles between the point and its ring.
  struct Fan {
    Vector normal = {}, laplacian = {};
    Pack circumcentric = {}, barycentric = {};
  };

  DF_INLINE static void dot(const Vector& a, const Vector& b, Pack& out) {
    out = a.x * b.x + a.y * b.y + a.z * b.z;
  }
  DF_INLINE static void add(Vector& to, const Pack& scale, const Vector& v) {
    to.x += scale * v.x;
    to.y += scale * v.y;
    to.z += scale * v.z;
  }
  DF_INLINE static void turned(const Turn& a, const Turn& b, Turn& out) {
    out = {a.cosine * b.cosine - a.sine * b.sine, a.cosine * b.sine + a.sine * b.cosine};
  }
  DF_INLINE static void put(const Mask& where, const Pack& value, T* to) {
    const Pack zero = {};
    P::store(where ? value : zero, to);
  }

  DF_INLINE static void add_wedge(Ring& ring, Fan& fan, int a, int b, T weight, Turn& between,
                                  Mask& done) {
    const Vector &p = ring.p[a], &q = ring.p[b];
    const Vector cross = {p.y * q.z - p.z * q.y, p.z * q.x - p.x * q.z, p.x * q.y - p.y * q.x};
    Pack cosine, square, sine;
    dot(p, q, cosine);
    dot(cross, cross, square);
    done &= square > thinnest_ring_square * ring.square[a] * ring.square[b];
    P::root(square, sine);
    add(fan.normal, weight * ring.inverse[a] * ring.inverse[b], cross);
    const Pack scale = T(0.5) * weight / sine;
    const Pack at_a = scale * (ring.square[a] - cosine), at_b = scale * (ring.square[b] - cosine);
    add(fan.laplacian, at_b, p);
    add(fan.laplacian, at_a, q);
    ring.cotangent[a] += at_b;
    ring.cotangent[b] += at_a;
    fan.circumcentric += T(0.25) * (at_b * ring.square[a] + at_a * ring.square[b]);
    fan.barycentric += weight / 6 * sine;
    const Pack inverse = ring.inverse_radius[a] * ring.inverse_radius[b];
    between = {cosine * inverse, sine * inverse};
  }

  DF_INLINE static void load(const RunRings& run, std::size_t first, Ring& ring, Mask& done) {
    Vector centre;
    P::load(run.at[0][0] + first, centre.x);
    P::load(run.at[0][1] + first, centre.y);
    P::load(run.at[0][2] + first, centre.z);
    for (int j = 0; j < run.size; ++j) {
      Vector& p = ring.p[j];
      P::load(run.at[j + 1][0] + first, p.x);
      P::load(run.at[j + 1][1] + first, p.y);
      P::load(run.at[j + 1][2] + first, p.z);
      p.x -= centre.x, p.y -= centre.y, p.z -= centre.z;
      dot(p, p, ring.square[j]);
      done &= ring.square[j] > ring_nearest;
      ring.inverse[j] = T(1) / ring.square[j];
      P::root(ring.square[j], ring.radius[j]);
      ring.inverse_radius[j] = ring.radius[j] * ring.inverse[j];
      ring.cotangent[j] = Pack{};
    }
  }

  DF_INLINE static void sum_up(const RunRings& run, Ring& ring, Fan& fan, Pack& total, Mask& done) {
    total = Pack{};
    const int size = run.size;
    for (int j = 1; j <= size; ++j) {
      const int here = j < size ? j : 0, next = here + 1 < size ? here + 1 : 0;
      const bool split = run.far[j] || run.far[here + 1];
      add_wedge(ring, fan, j - 1, here, split ? T(0.5) : T(1), ring.turn[here], done);
      if (run.far[here + 1]) {
        Turn unused;
        add_wedge(ring, fan, j - 1, next, T(0.5), unused, done);
      }
      angle_of_pack(ring.turn[here], ring.angle[here]);
      total += ring.angle[here];
    }
  }

  // angle_of(), at unit length.
  DF_INLINE static void angle_of_pack(const Turn& turn, Pack& out) {
    const Pack n = turn.sine, d = T(1) + turn.cosine;
    const Mask steep = n > d;
    const Pack low = steep ? d : n, high = steep ? n : d;
    Pack half;
    half_angle_series((low - tangent_of_eighth * high) / (high + tangent_of_eighth * low), half);
    out = steep ? T(std::numbers::pi) - T(2) * half : T(2) * half;
  }

  // From the turns between neighbours to their directions in the chart.
  DF_INLINE static void lay_out(int size, Ring& ring, const Pack& total, Mask& done) {
    const Pack excess = T(full_turn) / total - T(1);
    ring.turn[0] = {Pack{} + T(1), Pack{}};
    for (int j = 1; j < size; ++j) {
      const Pack angle = excess * ring.angle[j];
      done &= angle * angle <= T(small_turn_limit * small_turn_limit);
      Turn correction;
      small_turn_series(angle, correction.cosine, correction.sine);
      Turn step;
      turned(ring.turn[j], correction, step);
      turned(ring.turn[j - 1], step, ring.turn[j]);
    }
  }

  DF_INLINE static void lift(const RunRings& run, std::size_t first, Ring& ring, Fan& fan) {
    const Pack zero = {};
    Pack own;
    widen(run.lift[0] + first, own);
    for (int j = 0; j < run.size; ++j) {
      Pack share;
      widen(run.lift[j + 1] + first, share);
      share = share > own ? share : own;
      const Pack extra = ring.cotangent[j] < zero ? share * -ring.cotangent[j] : zero;
      ring.cotangent[j] += extra;
      add(fan.laplacian, extra, ring.p[j]);
      fan.circumcentric += T(0.25) * extra * ring.square[j];
    }
  }
  DF_INLINE static void widen(const float* from, Pack& to) {
    for (int l = 0; l < P::size; ++l) to[l] = T(from[l]);
  }

  using Fit = RoundFit<Pack, T>;
  using Term = typename Fit::Term;

  // The ring as a fit reads it.
  struct Neighbours {
    const Ring& ring;
    DF_INLINE void operator()(int j, Pack& u, Pack& v, Pack& weight) const {
      u = ring.radius[j] * ring.turn[j].cosine;
      v = ring.radius[j] * ring.turn[j].sine;
      weight = ring.weight[j];
    }
  };
  // Neighbour j's terms times g.
  DF_INLINE static void weigh(const Fit& f, const Ring& ring, int j, const Pack& g, Term& t) {
    Pack u, v, unused;
    Neighbours{ring}(j, u, v, unused);
    f.term(u, v, t);
    t.x = g * t.x, t.y = g * t.y, t.a = g * t.a, t.b = g * t.b, t.c = g * t.c;
  }
  DF_INLINE static void make_fit(int size, const Ring& ring, Fit& f, Mask& done) {
    Pack uu = {}, uv = {}, vv = {};
    for (int j = 0; j < size; ++j) {
      // a neighbour's weight times its squared distance
      const Pack w = ring.weight[j] * ring.square[j];
      const Turn& t = ring.turn[j];
      uu += w * t.cosine * t.cosine;
      uv += w * t.cosine * t.sine;
      vv += w * t.sine * t.sine;
    }
    f.make(size, uu, uv, vv, Neighbours{ring}, done);
  }
  // The trace-free part of what the sums stand for.
  DF_INLINE static void solve_fit(const Fit& f, const Term& sum, Pack& difference, Pack& mixed) {
    Pack xx, xy, yy;
    f.solve(sum, xx, xy, yy);
    difference = T(root_half) *
                 (f.w0 * f.w0 * xx + T(2) * f.w0 * f.w1 * xy + (f.w1 * f.w1 - f.w2 * f.w2) * yy);
    mixed = T(std::numbers::sqrt2) * (f.w2 * (f.w0 * xy + f.w1 * yy));
  }

  DF_INLINE static void find_axis(int size, const Ring& ring, const Vector& normal,
                                  const Mask& done, CurvatureLanes& out, int lane) {
    Pack along, length;
    dot(ring.p[0], normal, along);
    Vector u = ring.p[0];
    add(u, -along, normal);
    dot(u, u, length);
    P::root(length, length);
    const Pack unit = T(1) / length;
    u = {unit * u.x, unit * u.y, unit * u.z};
    const Vector v = {normal.y * u.z - normal.z * u.y, normal.z * u.x - normal.x * u.z,
                      normal.x * u.y - normal.y * u.x};
    Pack cosine = {}, sine = {};
    for (int j = 0; j < size; ++j) {
      Pack x, y;
      dot(ring.p[j], u, x);
      dot(ring.p[j], v, y);
      P::root(x * x + y * y, length);
      const Pack inverse = T(1) / length;
      const Turn& c = ring.turn[j];
      cosine += inverse * (x * c.cosine + y * c.sine);
      sine += inverse * (y * c.cosine - x * c.sine);
    }
    P::root(cosine * cosine + sine * sine, length);
    const Pack inverse = T(1) / length;
    cosine *= inverse;
    sine *= inverse;
    put(done, cosine * u.x + sine * v.x, out.axis[0] + lane);
    put(done, cosine * u.y + sine * v.y, out.axis[1] + lane);
    put(done, cosine * u.z + sine * v.z, out.axis[2] + lane);
  }

  DF_INLINE static void put_rows(int size, const Ring& ring, const Fit& fit, CurvatureEnergy energy,
                                 const Pack& trace, const Pack& area, const Pack& a, const Pack& b,
                                 const Mask& done, CurvatureLanes& out, int lane) {
    Pack rows[8][2], round[2] = {};
    for (int j = 0; j < size; ++j) {
      Term t;
      weigh(fit, ring, j, ring.weight[j], t);
      solve_fit(fit, t, rows[j][0], rows[j][1]);
      round[0] += ring.square[j] * rows[j][0];
      round[1] += ring.square[j] * rows[j][1];
    }
    const Pack scale = T(root_half) / area, square = a * a + b * b;
    round[0] *= T(0.5 * root_half);
    round[1] *= T(0.5 * root_half);
    Pack own[3];
    own_term(energy, trace, a, b, square, own[0], own[1], own[2]);
    for (int j = 0; j < size; ++j) {
      const Pack first = scale * ring.cotangent[j];
      const Pack second = rows[j][0] - first * round[0], third = rows[j][1] - first * round[1];
      own[0] -= first;
      own[1] -= second;
      own[2] -= third;
      put(done, first, out.row[j + 1][0] + lane);
      put(done, second, out.row[j + 1][1] + lane);
      put(done, third, out.row[j + 1][2] + lane);
      put(done, ring.cotangent[j], out.cotangent[j + 1] + lane);
    }
    for (int c = 0; c < 3; ++c) put(done, own[c], out.row[0][c] + lane);
    put(done, Pack{}, out.cotangent[0] + lane);
  }

  DF_INLINE static void run(const RunRings* rings, std::size_t begin, CurvatureEnergy energy,
                            bool wants_axis, CurvatureLanes* out) {
    for (int lane = 0; lane < lane_count; lane += P::size) {
      const std::size_t first = begin + std::size_t(lane);
      const int size = rings->size;
      Ring ring;
      Fan fan;
      Pack total, length;
      Mask done = Pack{} == Pack{};
      load(*rings, first, ring, done);
      sum_up(*rings, ring, fan, total, done);
      if (rings->lift[0]) lift(*rings, first, ring, fan);
      dot(fan.normal, fan.normal, length);
      P::root(length, length);
      done &= (length > T(0)) & (length < T(1e300)) & (total > T(0));
      const Pack unit = T(1) / length;
      const Vector normal = {unit * fan.normal.x, unit * fan.normal.y, unit * fan.normal.z};
      lay_out(size, ring, total, done);
      for (int j = 0; j < size; ++j)
        ring.weight[j] = (rings->far[j + 1] ? T(far_corner_weight) : T(1)) * ring.inverse[j];

      done &= fan.circumcentric >= T(least_area_share) * fan.barycentric;
      const Pack& area = fan.circumcentric;
      Pack trace;
      dot(normal, fan.laplacian, trace);
      trace = trace / area;
      Fit fit;
      make_fit(size, ring, fit, done);
      Term sum = {};
      for (int j = 0; j < size; ++j) {
        Pack height;
        dot(normal, ring.p[j], height);
        const Pack g = ring.weight[j] * (height - T(0.25) * trace * ring.square[j]);
        Term t;
        weigh(fit, ring, j, g, t);
        sum.x += t.x, sum.y += t.y, sum.a += t.a, sum.b += t.b, sum.c += t.c;
      }
      Pack a, b;
      solve_fit(fit, sum, a, b);
      done &= a * a + b * b < T(1e300);

      put(done, normal.x, out->normal[0] + lane);
      put(done, normal.y, out->normal[1] + lane);
      put(done, normal.z, out->normal[2] + lane);
      put(done, T(root_half) * trace, out->shape[0] + lane);
      put(done, a, out->shape[1] + lane);
      put(done, b, out->shape[2] + lane);
      put(done, area, out->area + lane);
      for (int l = 0; l < P::size; ++l) out->done[lane + l] = done[l] != 0;
      if (wants_axis) find_axis(size, ring, normal, done, *out, lane);
      put_rows(size, ring, fit, energy, trace, area, a, b, done, *out, lane);
    }
  }
};

}  // namespace

void linearize(const RunRings& run, std::size_t first, CurvatureEnergy energy, bool wants_axis,
               CurvatureLanes& out) {
  run_loop<ShapeLoop, double>(&run, first, energy, wants_axis, &out);
}

}  // namespace fairing
