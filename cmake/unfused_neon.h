// SPDX-License-Identifier: GPL-3.0-or-later
// Read before every file on 64-bit ARM: Eigen then multiplies and adds as on x86-64, in two
// operations that round each. Its kernels ask for fused ones by name, which no option forbids.
#ifndef DF_UNFUSED_NEON_H
#define DF_UNFUSED_NEON_H

#include <arm_neon.h>

#undef __ARM_FEATURE_FMA  // Eigen's pmadd asks for it, after the compiler's header has
#undef vfmaq_laneq_f32
#undef vfmaq_laneq_f64
#define vfmaq_n_f32(c, a, b) vaddq_f32(c, vmulq_n_f32(a, b))
#define vfmaq_n_f64(c, a, b) vaddq_f64(c, vmulq_n_f64(a, b))
#define vfmaq_laneq_f32(c, a, b, lane) vaddq_f32(c, vmulq_laneq_f32(a, b, lane))
#define vfmaq_laneq_f64(c, a, b, lane) vaddq_f64(c, vmulq_laneq_f64(a, b, lane))

#endif
