// SPDX-License-Identifier: GPL-3.0-or-later
// What holds the plate's control vertices beside the points that stay: pads with their loads, and
// couples that fix normals. How a level starts with both, and which slopes a couple makes; solve_held.cpp
// corrects them.
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
  // Of the pads as they stand, on a level's points; null: there are none.
  std::shared_ptr<const Hats> hats(int level);
  // On a level's points; null: no normal is fixed, or hats have no points there.
  std::shared_ptr<const LevelCouples> couples(int level);
  // Which slopes couples make, by which they are corrected: measured once, by trial solves on the level
  // that asks first.
  const Compliance& compliance(int level, int max_iterations);
  // Of the surface at each control vertex, K's diagonal on level 0; empty where none moves.
  const std::vector<double>& stiffness() const { return stiffness_; }

  // Of a surface that no load and no couple holds yet.
  PlateState unheld() const;
  // state <- for the start of a level, from that of the one below. `forces_below` are those of the
  // hats there, from the level before on; `foretells`: whether they say how loads change.
  void start(int level, bool foretells, PlateState& state, Loads& forces_below);
  // Where x has diverged from the mesh, point forces take the place of pads. Whether any does.
  bool deactivate_diverged_pads(int level, std::span<const Vec3> targets, const double* x);

 private:
  void start_loads(int level, bool foretells, Loads& loads, Loads& forces_below);
  void start_couples(int level, Moments& moments);
  void measure_couples(int level, int max_iterations);

  ThinPlateLevels& levels_;
  std::unique_ptr<Pads> pads_;
  std::shared_ptr<const Hats> hats_;  // of the latest level; null: not known
  std::unique_ptr<Couples> couples_;
  std::shared_ptr<const LevelCouples> level_couples_;  // of the latest level; null: none
  std::optional<Compliance> compliance_;
  std::vector<double> stiffness_;
};

}  // namespace fairing
