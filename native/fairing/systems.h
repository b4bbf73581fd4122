// SPDX-License-Identifier: GPL-3.0-or-later
// The systems with which the surfaces of one problem are solved. fair() uses them once for each
// shape, FairSolver repeatedly; they may be dropped in between.
#pragma once

#include <memory>
#include <optional>

#include "curvature/solver.h"
#include "fairing/plate_folds.h"
#include "fairing/problem.h"
#include "fairing/recent_surfaces.h"
#include "thin_plate/solver.h"

namespace fairing {

// Every member that takes a Stopwatch throws FairingError and bad_alloc. After an error the systems
// may be incomplete: drop() them, and they are built again.
class FairingSystems {
 public:
  // Builds that of the thin plate. `moves`: keeps what solve_moved() needs. Both references must
  // outlive the systems.
  FairingSystems(const FairingProblem& problem, Monitor& monitor, bool moves = false);

  // The thin plate's solver, built again if it was dropped. Its smoother adapts to the solved
  // surfaces until the first is written, so that the others depend on their own shapes alone.
  ThinPlateSolver& plate();
  // The positions on which a surface depends, in working coordinates: the held ones, and the cage
  // if the distance from its limit surface is penalized.
  std::vector<Vec3> positions_of(const ControlPositions& control) const;
  const GridLevel& finest() { return plate().levels().grid(problem_.options.levels); }
  // Frees the memory of all of them.
  void drop();

  // Solves one surface level by level: the thin plate, then Gauss-Newton steps for a curvature
  // energy. Reports levels, steps and corrections, and the prediction's energies if `measured`.
  Surface solve(const ControlPositions& control, bool measured, Stopwatch& watch, Report& report);
  // The surface of the basis, if it has to be solved before that of these positions: the metric of a
  // limit surface and the fold repair of a plate are those of the basis, so that shapes can be mixed,
  // and results do not depend on earlier ones.
  std::optional<Surface> solve_basis_before(const ControlPositions& control, Stopwatch& watch,
                                            Report& report);
  // As solve(), on the finest level alone, from the last surface of these systems. False if that does
  // not succeed: call solve(). `control` must outlive the next call.
  bool solve_moved(const ControlPositions& control, RecentSurfaces& recent, Stopwatch& watch,
                   Report& report);
  // Solves the plate's finest level again, from a surface of solve(), under external forces.
  void solve_under(std::span<const double> forces, const ControlPositions& control, Surface& out);
  // The loads on pads after moves of control vertices alone, from a plate that is zero: a linear
  // map, the same in x, y and z. With the accuracy of differences.
  Loads loads_of_moves(std::span<const Vec3> moves);

  // Writes the surface to `world`, which may be the array of its points, with epsilon applied if
  // requested. Reports its energies if `measured`, its deviation, and warnings of its thickness and
  // of a solve that has not converged. Throws too_extreme if the surface is not finite.
  void write(const ControlPositions& control, bool measured, Stopwatch& watch, Report& report,
             const Surface& surface, double* world);

 private:
  // The thin plate's surface without folds, `x` itself if it has none; and `control` with straight
  // curves if some had to become straight.
  struct RepairedPlate {
    const double* x;
    Array<double> own{};
    std::optional<ControlPositions> control{};
  };
  RepairedPlate without_folds(const ControlPositions& control, Report& report, const double* x);
  // From the basis' surface; `repaired` becomes that surface without folds, if any can be filled.
  void find_folds_of_basis(const double* x, Array<double>& repaired);
  // The right-hand side for the thin plate's surface of these positions. Valid until the next call,
  // and as long as `control` is.
  PlateData data_of(const ControlPositions& control);
  // The limit surface of a cage in working coordinates on the finest level, with control vertices
  // at their held positions; empty without a penalty.
  Array<double> reference_of(std::span<const Vec3> cage, std::span<const Vec3> held);
  // The reference of the steps on a level; empty without a penalty.
  Reference reference_on(int level, const PlateData& data);
  std::unique_ptr<GaussNewtonSolver> make_steps(const ControlPositions& control);
  Surface solve_levels(const ControlPositions& control,
                       const ThinPlateSolver::OnPrediction& predicted, Report& report);
  // Reports the pad widths of the latest surface and the errors of its fixed normals.
  void report_held(Report& report);
  SurfaceEnergies energies(const double* x);
  // During a solve: the energies of its start x on the finest level, if `measured`.
  ThinPlateSolver::OnPrediction on_prediction(bool measured, Stopwatch& watch, Report& report);
  bool releases() const {
    return problem_.options.paper.epsilon > 0 && problem_.options.energy == Energy::thin_plate;
  }

  const FairingProblem& problem_;
  Monitor& monitor_;
  const bool moves_;
  std::unique_ptr<ThinPlateSolver> plate_;
  std::unique_ptr<GaussNewtonSolver> steps_;  // for a curvature energy, after the first surface
  // Found for the basis; other positions get the same linear map, so that mixtures of shapes have
  // the mixtures of their surfaces.
  std::optional<PlateRepair> repair_;
  Array<double> reference_;
};

}  // namespace fairing
