// SPDX-License-Identifier: GPL-3.0-or-later
// Eigen reads this in the midst of its headers, as a plugin of DenseBase: after its vector
// instructions, before its products. Where instructions multiply and add at once, products and
// triangular solves take other blocks, hence other sums; without this macro, those of x86-64.
#undef EIGEN_HAS_SINGLE_INSTRUCTION_MADD
