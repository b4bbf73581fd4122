// SPDX-License-Identifier: GPL-3.0-or-later
// What all surfaces of one control mesh have in common, built once: threads, charts, stencils, the
// levels' systems. fair() uses it once, FairSolver again and again.
#pragma once

#include <memory>
#include <vector>

#include "curvature/solver.h"
#include "fairing/control_positions.h"
#include "fairing/fixed_normals.h"
#include "fairing/options.h"
#include "fairing/report.h"
#include "fairing/symmetry.h"
#include "stencil/stencils.h"
#include "thin_plate/solver.h"

namespace fairing {

// Throws FairingError and bad_alloc, from every member that takes a Stopwatch. After an error the
// systems may be half done: drop_systems(), and they are built anew.
class FairingContext {
 public:
  // Checks all input, and builds. Warnings and sizes go to `report`. `monitor` must outlive the
  // context, and so must what the spans of `options` show.
  FairingContext(const PolygonMesh& input, const FairOptions& options, Monitor& monitor,
                 Stopwatch& watch, Report& report);

  // The checks of fair() alone: throws what is wrong with a mesh, and puts warnings into `report`.
  void check(const PolygonMesh& input, Stopwatch& watch, Report& report) const;
  // Builds anew about other positions, 3 numbers an input vertex in world coordinates: charts,
  // stencils, curves, spectra. Faces, splits and creases stay. `control` becomes the new basis().
  // After an error all is as before, but for the systems, which have to be built again.
  void rebase(std::span<const double> coordinates, Stopwatch& watch, ControlPositions& control);

  const FairOptions& options() const { return options_; }
  const ControlMesh& mesh() const { return mesh_; }
  Workers& workers() { return *workers_; }

  // The positions that charts and stencils were built about.
  const ControlPositions& basis() const { return basis_; }
  // What a length in working coordinates is multiplied by to be one in world coordinates.
  double scale() const { return frame_.scale; }
  // Other positions of the input's vertices, 3 numbers each in world coordinates, with the basis'
  // parameters of curves.
  ControlPositions control_positions(std::span<const double> coordinates) const;

  // The levels' systems of the thin plate, built again where they have been dropped.
  ThinPlateSolver& system();
  const GridLevel& finest() { return system().grid(options_.levels); }
  // Gives the memory of all but mesh and stencils back.
  void drop_systems();

  // One surface from nothing, level by level: the thin plate's into x, 3 numbers a point in working
  // coordinates; that of a curvature energy is gauss_newton()->surface(), and `control` must
  // outlive it. Reports levels, steps and rounds; the prediction's energies only where they are to
  // be `measured`. The smoother adapts to the first surface that is solved.
  void solve(const ControlPositions& control, bool measured, Stopwatch& watch, Report& report,
             Array<double>& x);

  // What solve() has built for a curvature energy; null for the thin plate.
  GaussNewtonSolver* gauss_newton() { return gauss_newton_.get(); }
  // x <- the surface that solve() has found, given x as solve() left it. Frees gauss_newton().
  void move_surface(Array<double>& x);
  // How wide the pads of the latest surface are, and how its fixed normals came out.
  void report_held(Report& report);

  // From here on the systems are about these curves; they adapt to nothing.
  void use_curves_of(const ControlPositions& control) {
    system().take_shape(control.working_curves, start_weights_, false);
  }
  // The mirror symmetries that the mesh has with these positions too.
  Mirrors mirrors_of(const ControlPositions& control) const {
    return kept_by(control, mesh_, frame_, mirrors_);
  }

  // The thin plate's surface x after control vertices have been released by epsilon; the same where
  // that is not asked for.
  void release(const ControlPositions& control, Stopwatch& watch, Report& report, Array<double>& x);

  // For use during a solve: the energies of its start x on the finest level.
  void measure_prediction(const double* x, Stopwatch& watch, Report& report);

  // The surface x, in working coordinates, to `world`, which may be the same array; its energies,
  // where they are to be `measured`, and its deviation to `report`. Throws too_extreme where the
  // surface is not finite.
  void write(const ControlPositions& control, bool measured, Stopwatch& watch, Report& report,
             const double* x, double* world);

 private:
  std::unique_ptr<ChartMaker> charts() const;
  SurfaceEnergies energies(const double* x);
  template <class Hold>
  Hold hold_of(const ControlPositions& control, double unit) const;
  // One an input vertex and copy: in working coordinates, infinity: none; the caller's, or empty.
  std::vector<double> working_tolerances() const;
  std::vector<double> weights_with_copies() const;
  std::unique_ptr<GaussNewtonSolver> make_gauss_newton(const ControlPositions& control);
  void build(std::vector<Vec3> world, Stopwatch& watch);

  FairOptions options_;
  Monitor& monitor_;
  std::unique_ptr<Workers> workers_;
  double exponent_ = 0, weight_unit_ = 0;
  ControlMesh mesh_;  // in working coordinates
  Frame frame_;
  ControlPositions basis_;
  Stencils stencils_;
  std::vector<Mirror> mirrors_;
  Unknowns unknowns_;
  ChosenNormals normals_;
  VertexWeights start_weights_;
  std::unique_ptr<ThinPlateSolver> system_;
  std::unique_ptr<GaussNewtonSolver> gauss_newton_;
  bool has_adapted_ = false;
};

}  // namespace fairing
