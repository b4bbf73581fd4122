// SPDX-License-Identifier: GPL-3.0-or-later
// The least-squares quadratic of a ring of five and more neighbours in closed form, for numbers and
// packs (base/simd.h).
#pragma once

#include <cmath>
#include <numbers>

#include "base/simd.h"
#include "stencil/fit.h"

namespace fairing {

// Least squares after whitening the ring: x = w0 u and y = w1 u + w2 v have unit covariance and no
// correlation. The linear terms then drop out of the normal equations by division, and a 3 x 3
// system is left, for the coefficients of
//
//   a = x^2 + y^2,    b = x^2 - y^2,    c = 2 x y.
//
// N is double or a pack; S a single number of it.
template <class N, class S = N>
struct WhitenedFit {
  // A neighbour's x, y, a, b, c, or sums of these.
  struct Term {
    N x{}, y{}, a{}, b{}, c{};
  };
  // ring(j, u, v, weight) sets the coordinates and the weight of neighbour j. `determined` is
  // cleared, in each lane, if they do not determine a quadratic; the fit is then invalid.
  template <class Ring, class Mask>
  DF_INLINE void make(int size, const Ring& ring, Mask& determined) {
    N uu{}, uv{}, vv{};
    for (int j = 0; j < size; ++j) {
      N u, v, weight;
      ring(j, u, v, weight);
      uu += weight * u * u, uv += weight * u * v, vv += weight * v * v;
    }
    determined &= uu > S(0);
    const N rest = vv - uv * uv / uu;
    determined &= rest > S(thinnest_ring_square) * uu;
    const S n = S(size);
    each = 1 / n;
    Packs<S, sizeof(N)>::root(n / uu, w0);
    Packs<S, sizeof(N)>::root(n / rest, w2);
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
    // b and c rotate into each other with the chart, and b^2 + c^2 = a^2, so the least eigenvalue
    // of their remainder decides, whichever neighbour is first.
    const N least = S(0.5 * undetermined_square) * aa;
    determined &= (d1 > least) & ((d1 - least) * (t22 - least) > t12 * t12);
    l21 = t12 / d1;
    const N d2 = t22 - l21 * t12;
    inverse[0] = S(1) / s00;
    inverse[1] = S(1) / d1;
    inverse[2] = S(1) / d2;
  }

  // sum += the terms of a neighbour there, times g.
  DF_INLINE void add(const N& u, const N& v, const N& g, Term& sum) const {
    Term t;
    term(u, v, t);
    sum.x += g * t.x, sum.y += g * t.y, sum.a += g * t.a, sum.b += g * t.b, sum.c += g * t.c;
  }

  // The coefficients of stencil/fit.h of the quadratic with the right-hand side `sum`: the sum of
  // the neighbours' terms times their weights and differences.
  DF_INLINE void solve(const Term& sum, N (&out)[5]) const {
    const N r0 = sum.a - each * (sum.x * xa + sum.y * ya),
            r1 = sum.b - each * (sum.x * xb + sum.y * yb),
            r2 = sum.c - each * (sum.x * xc + sum.y * yc);
    const N z1 = r1 - l10 * r0;
    const N c2 = inverse[2] * (r2 - l20 * r0 - l21 * z1);
    const N c1 = inverse[1] * z1 - l21 * c2;
    const N c0 = inverse[0] * r0 - l10 * c1 - l20 * c2;
    const N x = each * (sum.x - xa * c0 - xb * c1 - xc * c2),
            y = each * (sum.y - ya * c0 - yb * c1 - yc * c2);
    out[0] = w0 * x + w1 * y;
    out[1] = w2 * y;
    const N xx = S(2) * (c0 + c1), xy = S(2) * c2, yy = S(2) * (c0 - c1);
    const N uu = w0 * w0 * xx + S(2) * w0 * w1 * xy + w1 * w1 * yy, vv = w2 * w2 * yy;
    out[2] = S(root_half) * (uu + vv);
    out[3] = S(root_half) * (uu - vv);
    out[4] = S(std::numbers::sqrt2) * (w2 * (w0 * xy + w1 * yy));
  }

 private:
  DF_INLINE void term(const N& u, const N& v, Term& t) const {
    t.x = w0 * u;
    t.y = w1 * u + w2 * v;
    const N xx = t.x * t.x, yy = t.y * t.y;
    t.a = xx + yy;
    t.b = xx - yy;
    t.c = S(2) * t.x * t.y;
  }

  S each;
  N w0, w1, w2;
  N xa, ya, xb, yb, xc, yc;
  N l10, l20, l21;
  N inverse[3];  // of the pivots
};

}  // namespace fairing
