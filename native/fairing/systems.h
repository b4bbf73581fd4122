// SPDX-License-Identifier: GPL-3.0-or-later
// The systems that the surfaces of one problem are solved with. fair() uses them once for each
// shape, FairSolver again and again; they may be dropped in between.
#pragma once

#include <memory>
#include <optional>

#include "curvature/solver.h"
#include "fairing/problem.h"
#include "fairing/unfold_plate.h"
#include "thin_plate/solver.h"

namespace fairing {

// Throws FairingError and bad_alloc, from every member that takes a Stopwatch. After an error the
// systems may be half done: drop() them, and they are built anew.
class FairingSystems {
 public:
  // Builds the thin plate's. Both references must outlive the systems.
  FairingSystems(const FairingProblem& problem, Monitor& monitor);

  // The thin plate's, built again where it has been dropped. Its smoother adapts to the surfaces
  // that are solved until keep_smoother().
  ThinPlateSolver& plate();
  // What the thin plate's surface of these positions is to come up to. Valid until the next call, and
  // as long as `control` is.
  PlateData data_of(const ControlPositions& control);
  // The limit surface of a cage in working coordinates on the finest level, with control vertices where
  // they are held; empty where nothing is drawn to it.
  Array<double> goal_of(std::span<const Vec3> cage, std::span<const Vec3> held);
  const GridLevel& finest() { return plate().levels().grid(problem_.options.levels); }
  // Gives the memory of all of them back.
  void drop();

  // One surface from nothing, level by level: the thin plate's into x, 3 numbers a point in working
  // coordinates; that of a curvature energy is gauss_newton()->surface(), and `control` must
  // outlive it. Reports levels, steps and rounds; the prediction's energies only where they are to
  // be `measured`. Returns what holds the plate.
  PlateState solve(const ControlPositions& control, bool measured, Stopwatch& watch, Report& report,
                   Array<double>& x);

  // What solve() has built for a curvature energy; null for the thin plate.
  GaussNewtonSolver* gauss_newton() { return gauss_newton_.get(); }
  // x <- the surface that solve() has found, given x as solve() left it. Frees gauss_newton().
  void move_surface(Array<double>& x);
  // How wide the pads of the latest surface are, and how its fixed normals came out.
  void report_held(Report& report);

  // The thin plate's surface x, held by `state`, after control vertices have been released by
  // epsilon; the same where that is not asked for.
  void release(const ControlPositions& control, PlateState state, Stopwatch& watch, Report& report,
               Array<double>& x);

  // For use during a solve: the energies of its start x on the finest level.
  void measure_prediction(const double* x, Stopwatch& watch, Report& report);

  // The surface x, in working coordinates, to `world`, which may be the same array; its energies,
  // where they are to be `measured`, its deviation and what is to be said of its thickness to `report`. Throws too_extreme where the
  // surface is not finite.
  void write(const ControlPositions& control, bool measured, Stopwatch& watch, Report& report,
             const double* x, double* world);

  // Whether it is known where a plate's folds are filled, or no plate is the surface.
  bool knows_folds() const {
    return repair_.has_value() || problem_.options.energy != Energy::thin_plate;
  }
  // From the basis' surface; `upright` becomes that surface without them, where any can be filled.
  void find_folds_of_basis(const double* x, Array<double>& upright);

 private:
  // The thin plate's surface without folds, which is `x` where that has none; where curves had to give
  // way, `control` with these.
  struct Upright {
    const double* x;
    Array<double> own{};
    std::optional<ControlPositions> control{};
  };
  Upright unfolded(const ControlPositions& control, Report& report, const double* x);
  SurfaceEnergies energies(const double* x);
  std::unique_ptr<GaussNewtonSolver> make_gauss_newton(const ControlPositions& control);

  const FairingProblem& problem_;
  Monitor& monitor_;
  std::unique_ptr<ThinPlateSolver> plate_;
  std::unique_ptr<GaussNewtonSolver> gauss_newton_;
  // Of the basis, once that has been solved; other positions get the same linear map, so that mixes of
  // shapes are shapes of mixes.
  std::optional<PlateRepair> repair_;
  Array<double> goal_;
};

}  // namespace fairing
