// SPDX-License-Identifier: GPL-3.0-or-later
// Pads with their loads and couples that fix normals: how a level starts with both, and the slopes
// of couples. solve_held.cpp corrects them.
#pragma once

#include <memory>
#include <optional>

#include "thin_plate/levels.h"
#include "thin_plate/plate_state.h"

namespace fairing {

class PlateSupports {
 public:
  // `charts` are those of the stencils. `levels` must outlive the supports.
  PlateSupports(const ChartMaker& charts, const ThinPlateOptions& options, ThinPlateLevels& levels);

  const Pads* pads() const { return pads_.get(); }  // null: point forces hold control vertices
  // The pads' hats on a level's points; null without pads.
  std::shared_ptr<const Hats> hats(int level);
  // On a level's points; null without fixed normals, or if hats have no points there.
  std::shared_ptr<const LevelCouples> couples(int level);
  // The slopes that couples make, by which they are corrected: measured once, by trial solves on
  // the first level that asks.
  const Compliance& compliance(int level, int max_iterations);
  // The surface's stiffness at each control vertex, K's diagonal on level 0; empty if none moves.
  const std::vector<double>& stiffness() const { return stiffness_; }

  // The state of a surface without loads and couples.
  PlateState unloaded() const;
  // state <- the start of a level, from that of the level below. `forces_below` are the forces of
  // the hats there relative to the level before; `foretells`: whether they predict the change of
  // the loads.
  void start(int level, bool foretells, PlateState& state, Loads& forces_below);

 private:
  void start_loads(int level, bool foretells, Loads& loads, Loads& forces_below);
  void start_couples(int level, Moments& moments);
  void measure_couples(int level, int max_iterations);

  ThinPlateLevels& levels_;
  std::unique_ptr<const Pads> pads_;
  std::shared_ptr<const Hats> hats_;  // of the latest level; null: not made yet
  std::unique_ptr<Couples> couples_;
  std::shared_ptr<const LevelCouples> level_couples_;  // of the latest level; null: none
  std::optional<Compliance> compliance_;
  std::vector<double> stiffness_;
};

}  // namespace fairing
