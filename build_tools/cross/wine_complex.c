/* SPDX-License-Identifier: GPL-3.0-or-later
   Functions of complex numbers, which NumPy 2 wants of Windows' C library and Wine 10's has not.
   By their textbook formulas: our tests have no complex numbers, NumPy only asks that they are there.
   wine_complex.py exports them without the prefix. */
#include <math.h>

typedef double _Complex number;
typedef float _Complex small;

static number made(double x, double y) {
  return __builtin_complex(x, y);
}

double df_creal(number z) {
  return __real__ z;
}
double df_cimag(number z) {
  return __imag__ z;
}
double df_cabs(number z) {
  return hypot(__real__ z, __imag__ z);
}
double df_carg(number z) {
  return atan2(__imag__ z, __real__ z);
}
number df_cexp(number z) {
  const double size = exp(__real__ z);
  return made(size * cos(__imag__ z), size * sin(__imag__ z));
}
number df_clog(number z) {
  return made(log(df_cabs(z)), df_carg(z));
}
number df_cpow(number z, number w) {
  return z == 0 ? made(w == 0, 0) : df_cexp(w * df_clog(z));
}
number df_csqrt(number z) {
  const double half = sqrt((fabs(__real__ z) + df_cabs(z)) / 2);
  if (half == 0) return made(0, __imag__ z);
  const double other = __imag__ z / (2 * half);
  return __real__ z >= 0 ? made(half, other) : made(fabs(other), copysign(half, __imag__ z));
}
number df_csinh(number z) {
  return made(sinh(__real__ z) * cos(__imag__ z), cosh(__real__ z) * sin(__imag__ z));
}
number df_ccosh(number z) {
  return made(cosh(__real__ z) * cos(__imag__ z), sinh(__real__ z) * sin(__imag__ z));
}
number df_ctanh(number z) {
  return df_csinh(z) / df_ccosh(z);
}
number df_csin(number z) {
  const number turned = df_csinh(made(-__imag__ z, __real__ z));
  return made(__imag__ turned, -__real__ turned);
}
number df_ccos(number z) {
  return df_ccosh(made(-__imag__ z, __real__ z));
}
number df_ctan(number z) {
  return df_csin(z) / df_ccos(z);
}
number df_catan(number z) {
  const number twice = df_clog(made(1 + __imag__ z, -__real__ z)) - df_clog(made(1 - __imag__ z, __real__ z));
  return made(-__imag__ twice / 2, __real__ twice / 2);
}

#define REAL(name) \
  float df_##name##f(small z) { \
    return (float)df_##name(z); \
  }
#define COMPLEX(name) \
  small df_##name##f(small z) { \
    return (small)df_##name(z); \
  }
REAL(creal) REAL(cimag) REAL(cabs) REAL(carg)
COMPLEX(cexp) COMPLEX(clog) COMPLEX(csqrt) COMPLEX(csinh) COMPLEX(ccosh) COMPLEX(ctanh)
COMPLEX(csin) COMPLEX(ccos) COMPLEX(ctan) COMPLEX(catan)
small df_cpowf(small z, small w) {
  return (small)df_cpow(z, w);
}
