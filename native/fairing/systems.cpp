// SPDX-License-Identifier: GPL-3.0-or-later
#include "fairing/systems.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/points.h"
#include "curvature/folds.h"
#include "curvature/total_curvature.h"
#include "fairing/extremes.h"
#include "fairing/output.h"
#include "fairing/warnings.h"
#include "grid/linear.h"
#include "paper/back_leg.h"
#include "paper/release.h"
#include "parallel/reductions.h"

namespace fairing {
namespace {

// Relative residual of the thin plate's surface if Gauss-Newton steps start from it: a balance
// between iterations for a surface that is replaced anyway and steps from a worse start.
constexpr double start_tolerance = 1e-3;

// `on_points`: the surface stands on point forces in spite of them.
PadReport report_of(const Pads& pads, std::size_t vertices, double unit, bool on_points) {
  PadReport out;
  for (std::size_t v = 0; v < vertices; ++v) {
    const bool under = pads.under(v);
    out.widths.push_back(under && !on_points ? unit * pads.reach(v) : 0.0);
    out.gone += under && on_points;
  }
  return out;
}

}  // namespace

FairingSystems::FairingSystems(const FairingProblem& problem, Monitor& monitor, bool moves)
    : problem_(problem), monitor_(monitor), moves_(moves) {
  plate();
}

ThinPlateSolver& FairingSystems::plate() {
  if (!plate_) {
    const FairOptions& options = problem_.options;
    ThinPlateOptions own;
    own.levels = options.levels;
    own.solve = options.solve;
    own.pad_size = options.width_of_pads();
    own.normals = problem_.normals.fixed;
    own.starts_steps = options.energy != Energy::thin_plate;
    if (problem_.held.surface) {
      auto penalty = std::make_shared<Array<float>>(problem_.held.surface->penalty(
          GridLevel(problem_.mesh, options.levels), problem_.basis.working, *problem_.workers));
      const double strength = std::pow(limit_penalty(options.limit), 0.25);
      for (float& p : *penalty)
        p = strength > 0 ? p * float(strength) : 0.0f;  // also where infinite
      own.penalty = {std::move(penalty), problem_.exponent};
    }
    plate_ = std::make_unique<ThinPlateSolver>(problem_.mesh, *problem_.charts(), problem_.stencils,
                                               problem_.unknowns, problem_.start_weights, own,
                                               *problem_.workers, monitor_);
  }
  return *plate_;
}

Array<double> FairingSystems::reference_of(std::span<const Vec3> cage, std::span<const Vec3> held) {
  return problem_.held.surface
             ? problem_.held.surface->at_points(finest(), flat(cage), held, *problem_.workers)
             : Array<double>();
}

PlateData FairingSystems::data_of(const ControlPositions& control) {
  reference_ = reference_of(control.cage_in(problem_.frame), control.working);
  return {control.working, control.working_curves, reference_.empty() ? nullptr : &reference_};
}

Reference FairingSystems::reference_on(int level, const PlateData& data) {
  if (!data.reference) return {};
  return {plate().levels().reference(level, data), plate().penalty(level)};
}

void FairingSystems::drop() {
  steps_.reset();
  plate_.reset();
}

std::unique_ptr<GaussNewtonSolver> FairingSystems::make_steps(const ControlPositions& control) {
  ThinPlateLevels& levels = plate().levels();
  if (problem_.options.energy == Energy::thin_plate || levels.base() > problem_.options.levels)
    return nullptr;
  GridLevels grids;
  for (int l = 0; l <= problem_.options.levels; ++l) grids.push_back(&levels.grid(l));
  GaussNewtonOptions options;
  if (problem_.options.energy == Energy::minimum_variation)
    options.energy = CurvatureEnergy::minimum_variation;
  const double length = problem_.units.edge_in_space;
  options.tension = problem_.options.membrane.strength() / (length * length);
  options.step_tolerance = problem_.options.step_tolerance_wanted();
  const double forces_left = 5 * problem_.options.solve.relative_residual;
  // relative to the loads; less than 1e-4 has not been measured
  options.load_tolerance = std::clamp(forces_left, 1e-4, largest_force_left);
  options.max_steps = problem_.options.max_steps;
  options.solve = problem_.options.solve;
  return std::make_unique<GaussNewtonSolver>(
      problem_.mesh, grids, levels.base(), problem_.stencils, problem_.unknowns, options,
      problem_.constraints_of(control, problem_.units.weight_in_space), plate().pads(),
      problem_.symmetry_of(control), *problem_.workers, monitor_);
}

std::vector<Vec3> FairingSystems::positions_of(const ControlPositions& control) const {
  std::vector<Vec3> out = control.working;
  if (problem_.held.surface) {
    const std::vector<Vec3> cage = control.cage_in(problem_.frame);
    out.insert(out.end(), cage.begin(), cage.end());
  }
  return out;
}

ThinPlateSolver::OnPrediction FairingSystems::on_prediction(bool measured, Stopwatch& watch,
                                                            Report& report) {
  if (!measured) return {};
  return [&](const double* start) {
    watch.enter(Phase::measure, 0.125);
    report.prediction = energies(start);
    watch.enter(Phase::solve, 0.25);
  };
}

Surface FairingSystems::solve_levels(const ControlPositions& control,
                                     const ThinPlateSolver::OnPrediction& predicted,
                                     Report& report) {
  const PlateData data = data_of(control);
  BallConstraints constraints =
      plate().begin(problem_.constraints_of(control, problem_.units.weight));
  PlateSurface surface, below;
  CurvedSurface curved;
  for (int level = plate().levels().base(); level <= plate().levels().top(); ++level) {
    below = std::exchange(surface, {});
    surface = plate().solve_level(level, data, constraints, below, report.levels, predicted);
    if (steps_)
      curved = steps_->solve_level(level, surface.x, below.x, reference_on(level, data),
                                   report.curvature.emplace_back());
  }
  return {std::move(surface.x), std::move(surface.state), std::move(curved)};
}

Surface FairingSystems::solve(const ControlPositions& control, bool measured, Stopwatch& watch,
                              Report& report) {
  watch.enter(Phase::solve, 0);
  steps_.reset();
  steps_ = make_steps(control);
  const auto predicted = on_prediction(measured, watch, report);
  const PaperOptions& paper = problem_.options.paper;
  Surface out;
  if (paper.method == Method::back_leg)
    solve_back_leg(plate().levels(), data_of(control), paper.sweeps, monitor_, out.plate,
                   report.levels, predicted);
  else
    out = solve_levels(control, predicted, report);
  for (const LevelReport& level : report.levels)
    report.constraint_rounds += level.constraint_rounds;
  report.constraint_gap = report.levels.back().constraint_gap;
  for (const CurvatureLevelReport& level : report.curvature) {
    for (const StepReport& step : level.steps) report.constraint_rounds += step.constraint_rounds;
    report.constraint_gap = level.constraint_gap;
  }
  report_held(report);
  if (!moves_) steps_.reset();
  return out;
}

std::optional<Surface> FairingSystems::solve_basis_before(const ControlPositions& control,
                                                          Stopwatch& watch, Report& report) {
  const ControlPositions& basis = problem_.basis;
  const bool has_metric =
      !problem_.held.surface || plate().levels().is_measured(problem_.options.levels);
  const bool knows_folds = repair_.has_value() || problem_.options.energy != Energy::thin_plate;
  if ((has_metric && knows_folds) || positions_of(control) == positions_of(basis)) return {};
  Surface out = solve(basis, false, watch, report);
  Array<double> repaired;
  find_folds_of_basis(out.plate.data(), repaired);
  return out;
}

// Moves the surface of the steps with that of the plate.
bool FairingSystems::solve_moved(const ControlPositions& control, RecentSurfaces& recent,
                                 Stopwatch& watch, Report& report) {
  const FairOptions& options = problem_.options;
  watch.enter(Phase::solve, 0);
  Surface& surface = recent.surface();
  Array<double>& curved = surface.curved.points;
  if (steps_ && !surface.curved.is_sound) return false;
  const auto add_plate = [&](double sign) {
    for_each_index(*problem_.workers, curved.size(),
                   [&](std::size_t i) { curved[i] += sign * surface.plate[i]; });
  };
  add_plate(-1);
  const std::vector<Vec3> positions = positions_of(control);
  recent.extrapolate(positions);
  const double tolerance = steps_ ? std::max(options.solve.relative_residual, start_tolerance)
                                  : options.solve.relative_residual;
  const std::span<const Vec3> before = recent.extrapolated();
  const std::span<const Vec3> held = before.first(control.working.size());
  const Array<double> reference = reference_of(before.subspan(held.size()), held);
  const PlateData data = data_of(control);
  plate().solve_moved({held, control.working_curves, &reference}, data, tolerance, surface.state,
                      surface.plate, report.levels, on_prediction(options.measure, watch, report));
  add_plate(1);
  if (steps_)
    steps_->solve_moved(problem_.symmetry_of(control), surface.plate,
                        reference_on(options.levels, data), surface.curved,
                        report.curvature.emplace_back());
  if (steps_ && !surface.curved.is_sound) return false;
  report_held(report);
  return true;
}

void FairingSystems::solve_under(std::span<const double> forces, const ControlPositions& control,
                                 Surface& out) {
  plate().solve_again({control.working, control.working_curves, nullptr, forces},
                      problem_.options.solve.relative_residual, out.state, out.plate);
}

Loads FairingSystems::loads_of_moves(std::span<const Vec3> moves) {
  FeatureCurves none = problem_.basis.working_curves;
  for (Vec3& p : none.points) p.setZero();
  PlateState state = plate().unloaded();
  state.loads.assign(moves.size(), Vec3::Zero());
  Array<double> x;
  x.assign(3 * finest().size(), 0.0);
  // the force at control vertices may be twice the tolerance
  plate().solve_again({moves, none}, difference_tolerance, state, x, 2 * difference_tolerance);
  return std::move(state.loads);
}

void FairingSystems::report_held(Report& report) {
  if (const Pads* const pads = plate().pads())
    report.pads = report_of(*pads, std::size_t(problem_.mesh.input_vertices), problem_.frame.scale,
                            steps_ && steps_->on_points());
  report_normals(problem_.normals, report.levels.back(), report);
}

// The energy of working coordinates in world units.
SurfaceEnergies FairingSystems::energies(const double* x) {
  SurfaceEnergies e;
  e.thin_plate = std::pow(problem_.frame.scale, 2 - 2 * problem_.exponent) *
                 plate().levels().bending(problem_.options.levels, x);
  e.total_curvature =
      problem_.options.measure ? total_curvature(finest(), *problem_.workers, x) : NAN;
  return e;
}

void FairingSystems::find_folds_of_basis(const double* x, Array<double>& repaired) {
  repair_.emplace();
  if (problem_.options.energy != Energy::thin_plate ||
      find_folds(finest(), *problem_.workers, x, {}).count() == 0)
    return;
  repaired.resize(3 * finest().size());
  std::copy_n(x, repaired.size(), repaired.begin());
  *repair_ = repair_plate_folds(problem_, problem_.basis, finest(), repaired);
}

FairingSystems::RepairedPlate FairingSystems::without_folds(const ControlPositions& control,
                                                            Report& report, const double* x) {
  RepairedPlate out{x};
  const bool basis = control.working == problem_.basis.working;
  if (basis) find_folds_of_basis(x, out.own);
  std::vector<Index> straight = control.world_curves.straightened;
  if (repair_ && repair_->any()) {
    if (!basis) {
      out.own.resize(3 * finest().size());
      std::copy_n(x, out.own.size(), out.own.begin());
      apply_plate_repair(problem_, control, finest(), *repair_, out.own);
    }
    out.x = out.own.data();
  }
  if (repair_ && !repair_->straightened.empty()) {
    out.control = control;
    straighten(problem_.mesh, repair_->straightened, control.world, out.control->world_curves);
    straight.insert(straight.end(), repair_->straightened.begin(), repair_->straightened.end());
  }
  warn_straightened(problem_.mesh, straight, report);
  return out;
}

void FairingSystems::write(const ControlPositions& control, bool measured, Stopwatch& watch,
                           Report& report, const Surface& surface, double* world) {
  const double* x = surface.points().data();
  Array<double> released;
  if (releases()) {
    watch.enter(Phase::constrain, 0.75);
    released = surface.plate;
    PlateState state = surface.state;
    report.constraint_rounds += release_control_vertices(
        plate(), data_of(control), problem_.options.paper.epsilon / problem_.frame.scale,
        problem_.options.solve.relative_residual, state, released);
    x = released.data();
  }
  const RepairedPlate repaired = without_folds(control, report, x);
  x = repaired.x;
  warn_of_thickness(finest(), *problem_.workers, x,
                    reference_.empty() ? nullptr : reference_.data(), problem_.options, report);
  if (measured) {
    watch.enter(Phase::measure, 0.75);
    report.result = energies(x);
    Array<double> polyhedron(3 * finest().size());
    refine_linearly(finest(), control.working, *problem_.workers, polyhedron.data());
    report.polyhedron = energies(polyhedron.data());
  } else {
    report.result = report.polyhedron = report.prediction = {NAN, NAN};
  }
  watch.enter(Phase::output, 0.875);
  to_world(repaired.control ? *repaired.control : control, finest(), problem_.frame,
           *problem_.workers, x, world);
  require_finite(problem_.mesh, control, *problem_.workers, 3 * finest().size(), world);
  report.largest_deviation = largest_deviation(control.cage, world);
  warn_unconverged(problem_.options, report);
  plate().keep_smoother();
}

}  // namespace fairing
