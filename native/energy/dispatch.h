// SPDX-License-Identifier: GPL-3.0-or-later
// Inner loops compiled twice, for any x86-64 and for AVX2, and chosen when the module is loaded. Both do the same
// operations in the same order (contraction is off), so the choice leaves no trace in the results.
#pragma once

#if defined(__x86_64__) && defined(__linux__) && defined(__GNUC__) && !defined(__clang__) && \
    !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define FAIRING_WIDE __attribute__((target_clones("avx2", "default"), flatten))
#else
#define FAIRING_WIDE
#endif
