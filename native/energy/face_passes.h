// SPDX-License-Identifier: GPL-3.0-or-later
// The two one-ring passes inside a control face: y = C d with the second differences d along the lattice directions,
// then the transposed differences of y. Rows of three interleaved coordinates; no branches.
#pragma once

#include <cstddef>

namespace fairing {

// Numbers of scratch that a pass wants.
constexpr std::size_t face_pass_scratch(int n) { return std::size_t(36) * std::size_t(n + 3); }

// closed += (second differences)^T C (second differences) x over the interior points of a closed triangle; c is a
// symmetric 3 x 3 matrix in rows of 4, scaled by `scale`.
void add_triangle_pass(int n, const float* c, float scale, const float* x, float* closed, float* scratch);
void add_triangle_pass(int n, const double* c, double scale, const double* x, double* closed,
                       double* scratch);

// The same for a quad: a 4 x 4 matrix on the directions s, s + t, t, t - s.
void add_quad_pass(int n, const float* c, float scale, const float* x, float* closed, float* scratch);
void add_quad_pass(int n, const double* c, double scale, const double* x, double* closed, double* scratch);

}  // namespace fairing
