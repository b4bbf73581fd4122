// SPDX-License-Identifier: GPL-3.0-or-later
// The systems that the surfaces of one problem are solved with. fair() uses them once for each
// shape, FairSolver again and again; they may be dropped in between.
#pragma once

#include <memory>
#include <optional>

#include "curvature/solver.h"
#include "fairing/problem.h"
#include "fairing/recent_surfaces.h"
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
  // What a surface depends on, in working coordinates: where it is held, and the cage where it is drawn to
  // that one's limit surface.
  std::vector<Vec3> positions_of(const ControlPositions& control) const;
  const GridLevel& finest() { return plate().levels().grid(problem_.options.levels); }
  // Gives the memory of all of them back.
  void drop();

  // One surface from nothing, level by level: the thin plate's, then Gauss-Newton steps from there for a
  // curvature energy. Reports levels, steps and rounds; the prediction's energies only where they are to
  // be `measured`.
  Surface solve(const ControlPositions& control, bool measured, Stopwatch& watch, Report& report);
  // The same from the last surface, which these systems have found, to the finest level's alone. False:
  // that does not go well, and solve() has to. `control` must outlive the next call.
  bool solve_moved(const ControlPositions& control, RecentSurfaces& recent, Stopwatch& watch,
                   Report& report);
  // Frees what only solve_moved() needs.
  void forget_steps() { steps_.reset(); }

  // The surface to `world`, which may be the array of its points, with control vertices released by
  // epsilon where that is asked for; its energies, where they are to be `measured`, its deviation and
  // what is to be said of its thickness to `report`. Throws too_extreme where the surface is not finite.
  void write(const ControlPositions& control, bool measured, Stopwatch& watch, Report& report,
             const Surface& surface, double* world);

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
  // What the thin plate's surface of these positions is to come up to. Valid until the next call, and
  // as long as `control` is.
  PlateData data_of(const ControlPositions& control);
  // The limit surface of a cage in working coordinates on the finest level, with control vertices where
  // they are held; empty where nothing is drawn to it.
  Array<double> goal_of(std::span<const Vec3> cage, std::span<const Vec3> held);
  std::unique_ptr<GaussNewtonSolver> make_steps(const ControlPositions& control);
  void solve_levels(const ControlPositions& control, const ThinPlateSolver::OnPrediction& predicted,
                    Report& report, Surface& out);
  // How wide the pads of the latest surface are, and how its fixed normals came out.
  void report_held(Report& report);
  SurfaceEnergies energies(const double* x);
  // During a solve: the energies of its start x on the finest level, where they are to be `measured`.
  ThinPlateSolver::OnPrediction on_prediction(bool measured, Stopwatch& watch, Report& report);
  bool releases() const {
    return problem_.options.paper.epsilon > 0 && problem_.options.energy == Energy::thin_plate;
  }

  const FairingProblem& problem_;
  Monitor& monitor_;
  std::unique_ptr<ThinPlateSolver> plate_;
  std::unique_ptr<GaussNewtonSolver> steps_;  // of a curvature energy, once a surface is solved
  // Of the basis, once that has been solved; other positions get the same linear map, so that mixes of
  // shapes are shapes of mixes.
  std::optional<PlateRepair> repair_;
  Array<double> goal_;
};

}  // namespace fairing
