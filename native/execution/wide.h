// SPDX-License-Identifier: GPL-3.0-or-later
// Inner loops on packs of numbers, in two forms: packs of 16 bytes for baseline instructions, of 32 for AVX2. The
// machine chooses at run time. Every number sees the same operations in the same order in both (no fused
// multiply-add, no sums across a pack), so the bits are the same.
#pragma once

#include <cstddef>
#include <cstring>

#if defined(__GNUC__)
#define DF_INLINE __attribute__((always_inline)) inline
#else
#define DF_INLINE inline
#endif

#if defined(__GNUC__) && defined(__x86_64__)
#define DF_HAS_WIDE 1
#else
#define DF_HAS_WIDE 0
#endif

namespace fairing {

#if defined(__GNUC__)
template <class T, int Bytes>
struct PackOf {
  typedef T Type __attribute__((vector_size(Bytes)));
};
#else
template <class T, int Bytes>
struct PackOf {
  struct Type {
    T number[Bytes / sizeof(T)];
    friend Type operator+(Type a, const Type& b) {
      return a.each(b, [](T x, T y) { return x + y; });
    }
    friend Type operator-(Type a, const Type& b) {
      return a.each(b, [](T x, T y) { return x - y; });
    }
    friend Type operator*(T s, Type a) {
      return a.each(a, [s](T x, T) { return s * x; });
    }
    Type& operator+=(const Type& b) { return *this = *this + b; }
    Type& operator-=(const Type& b) { return *this = *this - b; }

   private:
    template <class Operation>
    Type& each(const Type& b, Operation operation) {
      for (std::size_t i = 0; i < Bytes / sizeof(T); ++i) number[i] = operation(number[i], b.number[i]);
      return *this;
    }
  };
};
#endif

// Consecutive numbers, wherever they are. (No function takes or gives packs by value: that would be another ABI.)
template <class T, int Bytes>
struct Packs {
  using Pack = typename PackOf<T, Bytes>::Type;
  static constexpr int size = Bytes / int(sizeof(T));
  DF_INLINE static void load(const T* from, Pack& pack) { std::memcpy(&pack, from, sizeof pack); }
  DF_INLINE static void store(const Pack& pack, T* to) { std::memcpy(to, &pack, sizeof pack); }
};

#if DF_HAS_WIDE
inline bool machine_is_wide() {
  static const bool wide = __builtin_cpu_supports("avx2");
  return wide;
}

template <template <class, int> class Loop, class T, class... Arguments>
__attribute__((target("avx2"), noinline)) void run_wide(Arguments... arguments) {
  Loop<T, 32>::run(arguments...);
}
#endif

// Loop<T, bytes of a pack>::run(arguments…), which is marked DF_INLINE so that it is compiled where it is called.
template <template <class, int> class Loop, class T, class... Arguments>
inline void run_loop(Arguments... arguments) {
#if DF_HAS_WIDE
  if (machine_is_wide()) return run_wide<Loop, T, Arguments...>(arguments...);
#endif
  Loop<T, 16>::run(arguments...);
}

}  // namespace fairing
