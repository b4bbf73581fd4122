/* What these files take of musl's src/internal/libm.h: double precision, rounding to nearest or any other. */
#ifndef _LIBM_H
#define _LIBM_H

#include <float.h>
#include <math.h>
#include <stdint.h>

#if defined(_WIN32) /* where nothing is visible outside unless it is exported */
#define hidden
#else
#define hidden __attribute__((__visibility__("hidden")))
#endif

/* glibc's headers and others' libraries have functions of these names too.  */
#define __cos musl_kernel_cos
#define __sin musl_kernel_sin
#define __tan musl_kernel_tan
#define __rem_pio2 musl_rem_pio2
#define __rem_pio2_large musl_rem_pio2_large
#define __math_divzero musl_math_divzero
#define __math_invalid musl_math_invalid
#define __math_oflow musl_math_oflow
#define __math_uflow musl_math_uflow
#define __math_xflow musl_math_xflow
#define __exp_data musl_exp_data
#define __log_data musl_log_data
#define __log2_data musl_log2_data
#define __pow_log_data musl_pow_log_data

/* Support non-nearest rounding mode.  */
#define WANT_ROUNDING 1
#define TOINT_INTRINSICS 0
#define issignaling_inline(x) 0

/* The same operations everywhere: no fused ones where the processor has them.  */
#undef __FP_FAST_FMA
#define __FP_FAST_FMA 0

/* Helps static branch prediction so hot path can be better optimized.  */
#define predict_true(x) __builtin_expect(!!(x), 1)
#define predict_false(x) __builtin_expect(x, 0)

static inline double eval_as_double(double x)
{
	double y = x;
	return y;
}

/* fp_barrier returns its input, but limits code transformations
   as if it had a side-effect (e.g. observable io) and returned
   an arbitrary value.  */
static inline double fp_barrier(double x)
{
	volatile double y = x;
	return y;
}

static inline float fp_barrierf(float x)
{
	volatile float y = x;
	return y;
}

/* fp_force_eval ensures that the input value is computed when that's
   otherwise unused.  */
static inline void fp_force_evalf(float x)
{
	volatile float y;
	y = x;
}

static inline void fp_force_eval(double x)
{
	volatile double y;
	y = x;
}

#define FORCE_EVAL(x) do {                        \
	if (sizeof(x) == sizeof(float)) {         \
		fp_force_evalf(x);                \
	} else {                                  \
		fp_force_eval(x);                 \
	}                                         \
} while(0)

#define asuint64(f) ((union{double _f; uint64_t _i;}){f})._i
#define asdouble(i) ((union{uint64_t _i; double _f;}){i})._f

#define EXTRACT_WORDS(hi,lo,d)                    \
do {                                              \
  uint64_t __u = asuint64(d);                     \
  (hi) = __u >> 32;                               \
  (lo) = (uint32_t)__u;                           \
} while (0)

#define GET_HIGH_WORD(hi,d)                       \
do {                                              \
  (hi) = asuint64(d) >> 32;                       \
} while (0)

#define GET_LOW_WORD(lo,d)                        \
do {                                              \
  (lo) = (uint32_t)asuint64(d);                   \
} while (0)

#define INSERT_WORDS(d,hi,lo)                     \
do {                                              \
  (d) = asdouble(((uint64_t)(hi)<<32) | (uint32_t)(lo)); \
} while (0)

#define SET_HIGH_WORD(d,hi)                       \
  INSERT_WORDS(d, hi, (uint32_t)asuint64(d))

#define SET_LOW_WORD(d,lo)                        \
  INSERT_WORDS(d, asuint64(d)>>32, lo)

hidden int    __rem_pio2_large(double*,double*,int,int,int);
hidden int    __rem_pio2(double,double*);
hidden double __sin(double,double,int);
hidden double __cos(double,double);
hidden double __tan(double,double,int);

/* error handling functions */
hidden double __math_xflow(uint32_t, double);
hidden double __math_uflow(uint32_t);
hidden double __math_oflow(uint32_t);
hidden double __math_divzero(uint32_t);
hidden double __math_invalid(double);

#endif
