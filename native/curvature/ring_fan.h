// SPDX-License-Identifier: GPL-3.0-or-later
// Sums over the triangles between a point and its ring, and the ring's chart: for numbers, one
// point, or for packs of numbers (base/simd.h), several points of a run.
#pragma once

#include <cstdint>
#include <numbers>
#include <type_traits>

#include "base/simd.h"
#include "curvature/point_curvature.h"
#include "stencil/angle.h"
#include "stencil/fit.h"

namespace fairing {

// Lanes are never left out of a computation: a pack's `sound` excludes those that need another
// method, to which a single number branches at once. S: a single number of N.
template <class N, class S = N>
struct RingFan {
  static constexpr bool is_pack = !std::is_arithmetic_v<N>;
  using Mask = decltype(N{} < N{});
  using Neighbour = RingNeighbour<N>;
  using Vector = typename Neighbour::Vector;
  using Turn = typename Neighbour::Turn;

  Neighbour* at;
  int size;
  Vector normal = {}, laplacian = {};
  N circumcentric = {}, barycentric = {};  // areas
  N total = {};                            // sum of the angles between neighbours

  DF_INLINE static void dot(const Vector& a, const Vector& b, N& out) {
    out = a.x * b.x + a.y * b.y + a.z * b.z;
  }
  DF_INLINE static void add(Vector& to, const N& scale, const Vector& v) {
    to.x += scale * v.x;
    to.y += scale * v.y;
    to.z += scale * v.z;
  }
  DF_INLINE static void root(const N& of, N& out) { Packs<S, sizeof(N)>::root(of, out); }

  // Computes the lengths of a neighbour with an offset. `sound`: it differs from the point.
  DF_INLINE static void measure(Neighbour& n, Mask& sound) {
    dot(n.p, n.p, n.square);
    sound &= n.square > S(ring_nearest);
    n.inverse = S(1) / n.square;
    root(n.square, n.radius);
    n.inverse_radius = n.radius * n.inverse;
    n.cotangent = N{};
  }

  // `far`: as in SurfaceRing. `angles`: whether to compute the angles.
  template <bool angles>
  DF_INLINE void sum_up(const std::uint8_t* far, bool closed, Mask& sound) {
    for (int j = 1; j < size + closed; ++j) {
      const int here = j < size ? j : 0, next = here + 1 < size ? here + 1 : 0;
      Turn& turn = at[here].turn;
      add_triangle(j - 1, here, far[j - 1] || far[here] ? S(0.5) : S(1), turn, sound);
      if (far[here]) {
        Turn unused;
        add_triangle(j - 1, next, S(0.5), unused, sound);
      }
      if constexpr (angles) {
        angle_of_turn(turn, at[here].angle);
        total += at[here].angle;
      }
    }
  }

  // Raises negative cotangents by shares of their distance to zero, from share(j, out).
  template <class Share>
  DF_INLINE void lift(Share&& share) {
    const N zero = {};
    for (int j = 0; j < size; ++j) {
      N of_edge;
      share(j, of_edge);
      const N extra = at[j].cotangent < zero ? of_edge * -at[j].cotangent : zero;
      at[j].cotangent += extra;
      add(laplacian, extra, at[j].p);
      circumcentric += S(0.25) * extra * at[j].square;
    }
  }

  // Scales the normal to unit length. `sound`: it exists and is finite.
  DF_INLINE void normalize(Mask& sound) {
    N length;
    dot(normal, normal, length);
    root(length, length);
    sound &= (length > S(0)) & (length < S(1e300)) & (total > S(0));
    const N unit = S(1) / length;
    normal = {unit * normal.x, unit * normal.y, unit * normal.z};
  }

  // Replaces the turns between neighbours by their directions in the chart, where the angle `full`
  // is a full turn; computes their weights in the fit.
  DF_INLINE void lay_out(const N& full, const std::uint8_t* far, Mask& sound) {
    const N excess = S(full_turn) / full - S(1);
    at[0].turn = {N{} + S(1), N{}};
    for (int j = 1; j < size; ++j) {
      Turn correction, step;
      const N angle = excess * at[j].angle;
      if constexpr (is_pack) {
        sound &= angle * angle <= S(small_turn_limit * small_turn_limit);
        small_turn_series(angle, correction.cosine, correction.sine);
      } else {
        small_turn(angle, correction.cosine, correction.sine);
      }
      turned(at[j].turn, correction, step);
      turned(at[j - 1].turn, step, at[j].turn);
    }
    for (int j = 0; j < size; ++j)
      at[j].weight = (far[j] ? S(far_corner_weight) : S(1)) * at[j].inverse;
  }

  // Computes the chart's u axis in space (chart_axis()). Neighbours along the normal are ignored.
  DF_INLINE void find_axis(Vector& axis) const {
    N along, unit;
    dot(at[0].p, normal, along);
    Vector u = at[0].p;
    add(u, -along, normal);
    dot(u, u, unit);
    invert_root(unit);
    u = {unit * u.x, unit * u.y, unit * u.z};
    const Vector v = {normal.y * u.z - normal.z * u.y, normal.z * u.x - normal.x * u.z,
                      normal.x * u.y - normal.y * u.x};
    N cosine = {}, sine = {};
    for (int j = 0; j < size; ++j) {
      N x, y;
      dot(at[j].p, u, x);
      dot(at[j].p, v, y);
      unit = x * x + y * y;
      invert_root(unit);
      const Turn& c = at[j].turn;
      cosine += unit * (x * c.cosine + y * c.sine);
      sine += unit * (y * c.cosine - x * c.sine);
    }
    unit = cosine * cosine + sine * sine;
    invert_root(unit);
    cosine *= unit;
    sine *= unit;
    axis = {cosine * u.x + sine * v.x, cosine * u.y + sine * v.y, cosine * u.z + sine * v.z};
  }

 private:
  DF_INLINE static void invert_root(N& x) {
    const N zero = {};
    N length;
    root(x, length);
    x = length > zero ? S(1) / length : zero;
  }
  DF_INLINE static void turned(const Turn& a, const Turn& b, Turn& out) {
    out = {a.cosine * b.cosine - a.sine * b.sine, a.cosine * b.sine + a.sine * b.cosine};
  }

  // angle_of(), for unit length.
  DF_INLINE static void angle_of_turn(const Turn& turn, N& out) {
    const N n = turn.sine, d = S(1) + turn.cosine;
    const Mask steep = n > d;
    const N low = steep ? d : n, high = steep ? n : d;
    N half;
    half_angle_series((low - tangent_of_eighth * high) / (high + tangent_of_eighth * low), half);
    out = steep ? S(std::numbers::pi) - S(2) * half : S(2) * half;
  }

  // A triangle without an area is ignored.
  DF_INLINE void add_triangle(int a, int b, S weight, Turn& between, Mask& sound) {
    Neighbour &m = at[a], &n = at[b];
    const Vector &p = m.p, &q = n.p;
    const Vector cross = {p.y * q.z - p.z * q.y, p.z * q.x - p.x * q.z, p.x * q.y - p.y * q.x};
    N cosine, square, sine;
    dot(p, q, cosine);
    dot(cross, cross, square);
    root(square, sine);
    const N inverse = m.inverse_radius * n.inverse_radius;
    between = {cosine * inverse, sine * inverse};
    const Mask has_area = square > S(thinnest_ring_square) * m.square * n.square;
    if constexpr (is_pack)
      sound &= has_area;
    else if (!has_area)
      return;
    add(normal, weight * m.inverse * n.inverse, cross);
    const N scale = S(0.5) * weight / sine;
    const N at_a = scale * (m.square - cosine), at_b = scale * (n.square - cosine);
    add(laplacian, at_b, p);
    add(laplacian, at_a, q);
    m.cotangent += at_b;
    n.cotangent += at_a;
    circumcentric += S(0.25) * (at_b * m.square + at_a * n.square);
    barycentric += weight / 6 * sine;
  }
};

}  // namespace fairing
