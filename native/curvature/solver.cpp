// SPDX-License-Identifier: GPL-3.0-or-later
#include "curvature/solver.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "curvature/fold_repair.h"
#include "curvature/start.h"
#include "curvature/steps.h"
#include "curvature/thin_rows.h"
#include "curvature/total_curvature.h"
#include "parallel/reductions.h"

namespace fairing {
namespace {

// Plain steps to the end, undone if they make folds.
void polish_without_folds(SurfaceIterate& it, CurvatureLevelReport& report) {
  if (!is_near(report, damped_decrement)) return;
  LinearizedSurface before = it.current;
  CurvatureLevelReport polished = report;
  polish(it, longest_climb, polished);
  polished.folds = folds_of(it).count();
  if (polished.folds <= report.folds)
    report = std::move(polished);
  else
    it.current = std::move(before);
}

// Steps from `start` to least total curvature on point forces, with repair of folds on the finest
// level. Resets `report`. Throws ErrorCode::cancelled.
void run_fallback(SurfaceIterate& it, const StepStart& start, CurvatureLevelReport& report) {
  run_damped(it, start, {}, report);
  if (it.level < it.system.finest()) return;
  repair_folds(it, start, report);
  report.converged = report.left <= accurate_end(it).movement;
  // Vertices within tolerances are fixed first.
  if (!report.converged && !it.system.is_bound()) polish_without_folds(it, report);
}

// Below the finest level, steps on pads end at this decrement, as do steps that only start another
// energy: the remaining error is smaller than the change by the next level or by that energy.
constexpr double start_decrement = 1e-2;

// First level on which variation is minimized as a start for the next level. Coarser faces have too
// few points for third derivatives (bob, level 3: 3.2 s with level 2, 2.1 s without).
constexpr int first_of_variation = 3;

}  // namespace

GaussNewtonSolver::GaussNewtonSolver(const ControlMesh& mesh, const GridLevels& grids, int base,
                                     const Stencils& stencils, const Unknowns& unknowns,
                                     const GaussNewtonOptions& options,
                                     IntervalConstraints constraints, const Pads* pads,
                                     Symmetry symmetry, Workers& workers, Monitor& monitor)
    : constraints_(std::move(constraints)),
      pads_(pads),
      system_(mesh, grids, base, stencils, unknowns, options,
              constraints_.any() ? &constraints_ : nullptr, std::move(symmetry), workers, monitor),
      iterate_{system_, constraints_, folded_control_faces(mesh, constraints_.targets(), workers)} {
  if (base < system_.finest()) thickness_.emplace(mesh, constraints_.targets(), workers);
}

CurvedSurface GaussNewtonSolver::solve_level(int level, const Array<double>& plate,
                                             const Array<double>& plate_below, Reference reference,
                                             CurvatureLevelReport& report) {
  report.level = level;
  on_points_ = false;
  const StepWork before = system_.work(level);
  const std::span<const Vec3> given =
      level == system_.finest() ? constraints_.targets() : std::span<const Vec3>{};
  choose_start(iterate_, level, pads_, plate, plate_below, std::move(reference), given, report);
  // Rows are those of a reference, from which points moved along the surface would not come back.
  if (varies() && !iterate_.op().penalty() && straighten_thin_rows(iterate_))
    report.start_energy = iterate_.op().objective();
  const StepStart start{iterate_.current.points, iterate_.current.held, report};
  const bool is_plain = solve_total_curvature(start, plate, report);
  CurvedSurface out;
  if (is_finest()) {
    report.folds = folds_of(iterate_).count();
    out.is_sound = report.converged && is_plain && !constraints_.any();
    out.energy = report.energy;
    out.folds = report.folds;
  } else {
    below_ = {
        is_plain,
        report.swollen ||
            thickness_->of(iterate_.grid(), iterate_.workers(), surface().data()).is_bubble()};
  }
  keep_bending_alone(start, plate, report);
  report.work = system_.work(level) - before;
  if (is_finest()) out.points = std::move(surface());
  return out;
}

bool GaussNewtonSolver::solve_total_curvature(const StepStart& start, const Array<double>& plate,
                                              CurvatureLevelReport& report) {
  const bool is_plain = !is_lost(below_.is_plain) && step(start, report);
  report.swollen = is_lost(is_plain);
  if (report.swollen) {
    keep(plate, start, report);
    return false;
  }
  if (is_finest() && constraints_.any()) end_constraints(report);
  keep_start_if_worse(start, plate, report);
  if (varies()) vary(is_plain, report);
  return is_plain;
}

// The change of one level starts the next only if plain steps converged on all levels.
void GaussNewtonSolver::vary(bool is_plain, CurvatureLevelReport& report) {
  if (!is_plain || report.kept_start) variation_.change.clear();
  if (is_finest() && !report.kept_start)
    run_variation(iterate_, variation_, accurate_end(iterate_), report);
  else if (is_plain && !constraints_.any() && !variation_.vanishes &&
           iterate_.level >= first_of_variation)
    prepare_variation(iterate_, variation_, end());
}

// Plain steps, which converge without folds on an even mesh. If they fail, the mesh is rough on
// finer levels too, and the fallback runs. If they converge with folds, the fallback's surface
// replaces theirs only if it is as near to its solution and has fewer folds.
bool GaussNewtonSolver::step(const StepStart& start, CurvatureLevelReport& report) {
  if (below_.is_plain) run_plain(iterate_, pads_, end(), report);
  const bool is_plain = below_.is_plain && is_settled(report);
  if (is_plain && is_finest()) report.folds_before = report.folds = folds_of(iterate_).count();
  if (is_lost(is_plain)) return false;
  if (is_plain && report.folds == 0) return true;
  const LinearizedSurface plain = iterate_.current;
  const CurvatureLevelReport of_plain = report;
  run_fallback(iterate_, start, report);
  on_points_ =
      !is_plain || (report.folds < of_plain.folds && report.converged >= of_plain.converged);
  if (on_points_) return false;
  iterate_.current = plain;
  report = of_plain;
  return true;
}

StopCriterion GaussNewtonSolver::end() {
  if (is_finest() && (!varies() || variation_.vanishes)) return accurate_end(iterate_);
  return {pads_ ? start_decrement : plain_decrement, 0};
}

void GaussNewtonSolver::end_constraints(CurvatureLevelReport& report) {
  const bool any_moved = constraints_.active();
  if (any_moved) constraints_.enforce(surface().data());
  iterate_.current.held.bounds.clear();
  system_.fix_control_vertices(constraints_.without_held(), iterate_.level, iterate_.current);
  if (any_moved) polish(iterate_, plain_patience, report);
}

double GaussNewtonSolver::energy_beside_bending(const Array<double>& x) {
  double out = 0;
  if (const double tension = system_.options().tension; tension > 0)
    out += tension * surface_area(iterate_.grid(), iterate_.workers(), x.data());
  if (const auto& penalty = iterate_.op().penalty())
    out += penalty->energy(x.data(), iterate_.op().varies(), iterate_.workers());
  return out;
}

void GaussNewtonSolver::keep_bending_alone(const StepStart& start, const Array<double>& plate,
                                           CurvatureLevelReport& report) {
  report.plate_energy -= energy_beside_bending(plate);
  report.start_energy -= energy_beside_bending(start.points);
  report.energy -= energy_beside_bending(surface());
}

// Steps may end in a fold; then the surface at their start is better. If control vertices are
// constrained, that surface may violate the bounds, which the plate satisfies.
void GaussNewtonSolver::keep_start_if_worse(const StepStart& start, const Array<double>& plate,
                                            CurvatureLevelReport& report) {
  const double bound = report.converged ? energy_bound(report) : equal_energy * report.start_energy;
  if (report.energy <= bound) return;
  keep(is_finest() && constraints_.any() ? plate : start.points, start, report);
}

void GaussNewtonSolver::keep(const Array<double>& x, const StepStart& start,
                             CurvatureLevelReport& report) {
  surface() = x;
  system_.symmetrize(iterate_.level, surface());
  iterate_.current.held = start.held;
  iterate_.linearize();
  report.energy = iterate_.op().objective();
  report.left = std::numeric_limits<double>::infinity();
  report.converged = false;
  report.kept_start = true;
}

double GaussNewtonSolver::energy_bound(const CurvatureLevelReport& report) {
  return (pads_ ? other_minimum : 1.0) * report.plate_energy;
}

bool GaussNewtonSolver::is_settled(const CurvatureLevelReport& report) {
  const bool gap_closed = report.constraint_gap <= system_.wanted_gap(iterate_.level);
  return gap_closed && is_near(report, plain_decrement) && report.energy <= energy_bound(report);
}

void GaussNewtonSolver::solve_moved(Symmetry symmetry, const Array<double>& plate,
                                    Reference reference, CurvedSurface& moved,
                                    CurvatureLevelReport& report) {
  if (!reference.points.empty()) {
    LinearizedSurface of_plate;
    of_plate.points = plate;
    system_.linearize(iterate_.level, of_plate);
    system_.penalize(iterate_.level, std::move(reference), of_plate);
  }
  std::swap(surface(), moved.points);
  system_.set_symmetry(std::move(symmetry));
  iterate_.folded_faces =
      folded_control_faces(system_.mesh(), constraints_.targets(), iterate_.workers());
  moved.is_sound = steps_go_well(moved, report);
  moved.energy = report.energy;
  std::swap(surface(), moved.points);
  report.energy -= energy_beside_bending(moved.points);
}

bool GaussNewtonSolver::steps_go_well(const CurvedSurface& before, CurvatureLevelReport& report) {
  system_.symmetrize(iterate_.level, surface());
  iterate_.linearize();
  report.level = iterate_.level;
  report.plate_energy = NAN;  // unknown: the thin plate's surface has not been linearized
  report.start_energy = report.energy = iterate_.op().objective();
  if (!(report.start_energy <= incomparable_energy * before.energy + flat_energy)) return false;
  iterate_.is_near_earlier = std::max(report.start_energy, before.energy) <=
                             equal_energy * std::min(report.start_energy, before.energy);
  report.converged = true;
  const double beside_bending = energy_beside_bending(surface());
  if (varies())
    run_variation(iterate_, variation_, accurate_end(iterate_), report);
  else
    run_plain(iterate_, pads_, accurate_end(iterate_), report);
  report.folds_before = report.folds = folds_of(iterate_).count();
  const bool is_sound =
      report.converged && report.folds <= before.folds &&
      (varies() || report.energy <= equal_energy * report.start_energy + flat_energy);
  report.start_energy -= beside_bending;
  return is_sound;
}

}  // namespace fairing
