// SPDX-License-Identifier: GPL-3.0-or-later
// Points of a scan that a fit does not see, to judge its weight by.
#pragma once

#include "fit/level_fit.h"

namespace fairing {

// Average number of points in a cell that is held out, or that counts as covered: with this number
// one cell in fifty is empty by chance.
constexpr double points_a_blob = 4;

struct HeldOut {
  struct Test {
    std::size_t point;
    Foot foot;
    Vec3 normal;
  };
  std::vector<std::uint8_t> trained;  // of each point, whether the fit sees it
  std::vector<Test> tests;            // points whose distances count

  std::size_t trained_points() const;
};

// A tenth of the cells, each of some points.
HeldOut cells_held_out(const LevelFit& fit);

// Discs as wide as a scanner's noise is correlated to both sides, but no wider than a control edge,
// with tests in their middles only: points near a rim share their noise with points outside.
// Together the sets hold out the whole scan, about once.
std::vector<HeldOut> discs_held_out(const LevelFit& fit);

// The noise that a held-out point shares with others: the sum of the covariances of their offsets
// over a disc around it, without those over a ring of the same area around that, which are shape.
double shared_noise(const LevelFit& fit, const HeldOut& held);

}  // namespace fairing
