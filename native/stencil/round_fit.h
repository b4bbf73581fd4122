// SPDX-License-Identifier: GPL-3.0-or-later
// The least-squares quadratic of a closed ring of five and more neighbours in closed form, for
// numbers and for packs of them alike (base/simd.h).
#pragma once

#include <cmath>

#include "base/simd.h"
#include "stencil/fit.h"

namespace fairing {

// Least squares after the ring has been made round: x = w0 u and y = w1 u + w2 v have unit
// covariance and no correlation. The linear terms then drop out of the normal equations by division,
// and a 3 x 3 system is left, for the coefficients of
//
//   a = x^2 + y^2,    b = x^2 - y^2,    c = 2 x y.
//
// N is double or a pack; S a single number of it. A pack divides by each pivot once, and multiplies
// from then on; a number divides.
template <class N, class S = N>
struct RoundFit {
  static constexpr bool is_pack = sizeof(N) != sizeof(S);

  // A neighbour's x, y, a, b, c, or sums of such.
  struct Term {
    N x{}, y{}, a{}, b{}, c{};
  };
  // uu, uv, vv: the ring's weighted second moments. ring(j, u, v, weight) sets the coordinates and
  // the weight of neighbour j. `determined` &= whether, and in which lanes, they determine a
  // quadratic; elsewhere nothing of the fit may be used.
  template <class Ring, class Mask>
  DF_INLINE void make(int size, const N& uu, const N& uv, const N& vv, const Ring& ring,
                      Mask& determined) {
    determined &= uu > S(0);
    const N rest = vv - uv * uv / uu;
    determined &= rest > S(thinnest_ring_square) * uu;
    const S n = S(size);
    each = 1 / n;
    root(n / uu, w0);
    root(n / rest, w2);
    w1 = -w2 * uv / uu;
    N aa{}, ab{}, ac{}, bb{}, bc{}, cc{};
    xa = ya = xb = yb = xc = yc = N{};
    for (int j = 0; j < size; ++j) {
      N u, v, weight;
      ring(j, u, v, weight);
      Term t;
      term(u, v, t);
      const N x = weight * t.x, y = weight * t.y, a = weight * t.a, b = weight * t.b;
      aa += a * t.a, ab += a * t.b, ac += a * t.c, bb += b * t.b, bc += b * t.c;
      cc += weight * t.c * t.c;
      xa += x * t.a, ya += y * t.a, xb += x * t.b, yb += y * t.b, xc += x * t.c, yc += y * t.c;
    }
    const N s00 = aa - each * (xa * xa + ya * ya), s01 = ab - each * (xa * xb + ya * yb),
            s02 = ac - each * (xa * xc + ya * yc), s11 = bb - each * (xb * xb + yb * yb),
            s12 = bc - each * (xb * xc + yb * yc), s22 = cc - each * (xc * xc + yc * yc);
    determined &= s00 > S(undetermined_square) * aa;
    l10 = s01 / s00;
    l20 = s02 / s00;
    const N d1 = s11 - l10 * s01, t12 = s12 - l10 * s02, t22 = s22 - l20 * s02;
    // b and c turn into each other with the chart, and b^2 + c^2 = a^2: both eigenvalues of what is
    // left for them count, whichever neighbour is the first.
    const N least = S(0.5 * undetermined_square) * aa;
    determined &= (d1 > least) & ((d1 - least) * (t22 - least) > t12 * t12);
    l21 = t12 / d1;
    const N d2 = t22 - l21 * t12;
    set_pivot(s00, pivot[0]);
    set_pivot(d1, pivot[1]);
    set_pivot(d2, pivot[2]);
  }

  DF_INLINE void term(const N& u, const N& v, Term& t) const {
    t.x = w0 * u;
    t.y = w1 * u + w2 * v;
    const N xx = t.x * t.x, yy = t.y * t.y;
    t.a = xx + yy;
    t.b = xx - yy;
    t.c = S(2) * t.x * t.y;
  }

  // The second derivatives by x and y of the quadratic whose right-hand side `sum` is: of the
  // neighbours' terms times their weights and differences.
  DF_INLINE void solve(const Term& sum, N& xx, N& xy, N& yy) const {
    const N r0 = sum.a - each * (sum.x * xa + sum.y * ya),
            r1 = sum.b - each * (sum.x * xb + sum.y * yb),
            r2 = sum.c - each * (sum.x * xc + sum.y * yc);
    const N z1 = r1 - l10 * r0;
    N c0, c1, c2;
    divide(r2 - l20 * r0 - l21 * z1, pivot[2], c2);
    divide(z1, pivot[1], c1);
    c1 = c1 - l21 * c2;
    divide(r0, pivot[0], c0);
    c0 = c0 - l10 * c1 - l20 * c2;
    xx = S(2) * (c0 + c1);
    xy = S(2) * c2;
    yy = S(2) * (c0 - c1);
  }

  N w0, w1, w2;

 private:
  DF_INLINE static void root(const N& of, N& out) {
    if constexpr (is_pack) {
      for (int l = 0; l < int(sizeof(N) / sizeof(S)); ++l) out[l] = std::sqrt(of[l]);
    } else {
      out = std::sqrt(of);
    }
  }
  DF_INLINE static void set_pivot(const N& value, N& out) {
    if constexpr (is_pack)
      out = S(1) / value;
    else
      out = value;
  }
  DF_INLINE static void divide(const N& x, const N& by, N& out) {
    if constexpr (is_pack)
      out = x * by;
    else
      out = x / by;
  }

  S each;
  N xa, ya, xb, yb, xc, yc;
  N l10, l20, l21;
  N pivot[3];
};

}  // namespace fairing
