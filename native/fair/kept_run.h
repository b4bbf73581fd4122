// SPDX-License-Identifier: GPL-3.0-or-later
// What the surfaces of one control mesh have in common, built once: threads, charts, stencils, hierarchy.
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "difference/stencils.h"
#include "fair/constrain.h"
#include "fair/curvature.h"
#include "fair/options.h"
#include "fair/output.h"
#include "fair/placement.h"
#include "fair/stopwatch.h"
#include "fair/surface.h"

namespace fairing {

class KeptRun {
 public:
  // Checks all input, and builds. What there is to say before any solve goes to `report`. `monitor` must outlive the run;
  // so must what the spans of `options` show.
  KeptRun(const PolygonMesh& input, const FairOptions& options, Monitor& monitor, Stopwatch& watch,
          Report& report);

  // What fair() says against a mesh, and of it.
  void check(const PolygonMesh& input, Stopwatch& watch, Report& report) const;
  // Builds anew about other positions: charts, stencils, curves, spectra. Faces, splits and creases stay.
  void rebase(std::span<const double> coordinates, Stopwatch& watch);

  const FairOptions& options() const { return options_; }
  const ControlMesh& mesh() const { return mesh_; }
  const Frame& frame() const { return frame_; }
  const Placement& basis() const { return basis_; }
  Workers& workers() { return *workers_; }

  // Where other positions have vertices and curves. The mesh is as before afterwards.
  Placement place(std::span<const double> coordinates);

  // The levels' systems, which are built again where they have been dropped.
  SurfaceSystem& system();
  const Lattice& finest() { return system().lattice(options_.levels); }
  // Gives the memory of all but mesh and stencils back. What a solve has left half done goes with it.
  void drop_systems();

  struct Solved {
    std::vector<LevelReport> levels;
    std::vector<CurvatureLevelReport> curvature;
    int constraint_rounds = 0;
    double constraint_gap = 0;
  };
  // One surface from nothing, level by level: the thin plate's into x, in working coordinates. That of a curvature energy
  // is curved()->surface(); `place` must outlive it. The smoother adapts to the first surface that is solved.
  Solved solve(const Placement& place, Array<double>& x, Stopwatch& watch,
               const std::function<void(const double*)>& on_prediction);

  // Null for the thin plate.
  std::unique_ptr<CurvatureSystem>& curved() { return curved_; }
  Mirrors mirrors_of(const Placement& place) const { return kept_by(place, mesh_, frame_, mirrors_); }

  // From here on the systems are about this surface; its solve adapts nothing.
  void take(const Placement& place) { system().take_shape(place.working_curves, start_weights_, false); }

  // Lets control vertices go by epsilon, where that is asked for. Returns the solves taken.
  int release(const Placement& place, Stopwatch& watch, Array<double>& x);

  // Of a surface in working coordinates.
  SurfaceEnergies energies(const double* x);
  SurfaceEnergies polyhedron_energies(const Placement& place);

 private:
  ToleranceConstraint constraint_of(const Placement& place) const;
  std::unique_ptr<CurvatureSystem> make_curved(const Placement& place);
  void build(Stopwatch& watch);

  FairOptions options_;
  Monitor& monitor_;
  std::unique_ptr<Workers> workers_;
  double exponent_ = 0, weight_unit_ = 0;
  ControlMesh mesh_;  // in working coordinates
  Frame frame_;
  Placement basis_;
  Stencils stencils_;
  std::vector<Mirror> mirrors_;
  Unknowns unknowns_;
  VertexWeights start_weights_;
  std::unique_ptr<SurfaceSystem> system_;
  std::unique_ptr<CurvatureSystem> curved_;
  bool has_adapted_ = false;
};

// Adds the warning about a finest level that has not converged; `of` begins it.
void warn_unconverged(const LevelReport& level, const FairOptions& options, const std::string& of,
                      Report& report);

// 2 an edge: the control edges that became creases, by whatever rule.
Array<std::int32_t> crease_edges(const ControlMesh& mesh);

}  // namespace fairing
