// SPDX-License-Identifier: GPL-3.0-or-later
// Inner loops on packs of numbers, compiled twice: with packs of 16 bytes for baseline
// instructions, and of 32 bytes for AVX2; the machine chooses at run time. In both, every number
// has the same operations in the same order (no fused multiply-add, no sums across a pack), and so
// the same bits.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstring>
#if defined(_MSC_VER)
#include <intrin.h>
#endif

#define DF_INLINE __attribute__((always_inline)) inline

#if defined(__x86_64__)
#define DF_HAS_WIDE 1
#else
#define DF_HAS_WIDE 0
#endif

namespace fairing {

// A pack of one number is the number.
template <class T, int Bytes, bool is_one = Bytes == int(sizeof(T))>
struct PackOf {
  typedef T Type __attribute__((vector_size(Bytes)));
};
template <class T, int Bytes>
struct PackOf<T, Bytes, true> {
  using Type = T;
};

// Loads and stores of consecutive numbers, aligned or not. Packs are passed by reference only: by
// value, the two forms would have different calling conventions.
template <class T, int Bytes>
struct Packs {
  using Pack = typename PackOf<T, Bytes>::Type;
  using Mask = decltype(Pack{} < Pack{});
  static constexpr int size = Bytes / int(sizeof(T));
  DF_INLINE static void load(const T* from, Pack& pack) { std::memcpy(&pack, from, sizeof pack); }
  DF_INLINE static void store(const Pack& pack, T* to) { std::memcpy(to, &pack, sizeof pack); }
  // Loads numbers in single precision.
  DF_INLINE static void widen(const float* from, Pack& pack) {
    if constexpr (size == 1) {
      pack = T(*from);
    } else {
      typename PackOf<float, size* int(sizeof(float))>::Type single;
      std::memcpy(&single, from, sizeof single);
      pack = __builtin_convertvector(single, Pack);
    }
  }
  DF_INLINE static void root(const Pack& of, Pack& out) {
    if constexpr (size == 1)
      out = std::sqrt(of);
    else
      for (int l = 0; l < size; ++l) out[l] = std::sqrt(of[l]);
  }
};

#if DF_HAS_WIDE
#if defined(_MSC_VER)
// Clang beside Microsoft's library: the builtin below would want one of Clang's own.
__attribute__((target("xsave"))) inline bool machine_has_avx2() {
  int words[4] = {};
  __cpuid(words, 0);
  if (words[0] < 7) return false;
  __cpuid(words, 1);
  constexpr int system_saves = 1 << 27, avx = 1 << 28, both_halves = 6;
  if (!(words[2] & system_saves) || !(words[2] & avx)) return false;
  if ((_xgetbv(0) & both_halves) != both_halves) return false;
  __cpuidex(words, 7, 0);
  return words[1] & 1 << 5;
}
#else
inline bool machine_has_avx2() { return __builtin_cpu_supports("avx2"); }
#endif

inline bool machine_is_wide() {
  static const bool wide = machine_has_avx2();
  return wide;
}

template <template <class, int> class Loop, class T, class... Arguments>
__attribute__((target("avx2"), noinline)) void run_wide(Arguments... arguments) {
  Loop<T, 32>::run(arguments...);
}
#endif

// Calls Loop<T, bytes of a pack>::run(arguments…). Mark run() DF_INLINE, so that it is compiled
// into the function with these instructions.
template <template <class, int> class Loop, class T, class... Arguments>
inline void run_loop(Arguments... arguments) {
#if DF_HAS_WIDE
  if (machine_is_wide()) return run_wide<Loop, T, Arguments...>(arguments...);
#endif
  Loop<T, 16>::run(arguments...);
}

}  // namespace fairing
