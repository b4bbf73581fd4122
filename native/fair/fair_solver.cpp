// SPDX-License-Identifier: GPL-3.0-or-later
#include "fair/fair_solver.h"

#include <cmath>
#include <new>

#include "fair/world.h"

namespace fairing {
namespace {

// Of the thin plate's surface where it is a start only.
constexpr double start_tolerance = 1e-3;

const FairOptions& without_back_leg(const FairOptions& options) {
  if (options.method == Method::back_leg)
    throw FairingError(ErrorCode::bad_option,
                       "method=\"back_leg\" solves nothing that could be kept; a solver takes multigrid.");
  return options;
}

[[noreturn]] void out_of_memory() {
  throw FairingError(ErrorCode::out_of_memory, "Out of memory. Use fewer levels, or close other programs.");
}

}  // namespace

FairSolver::FairSolver(const PolygonMesh& input, const FairOptions& options, Monitor& monitor) try
    : monitor_(monitor),
      build_watch_(built_, monitor_),
      run_(input, without_back_leg(options), monitor_, build_watch_, built_),
      place_(run_.basis()),
      recent_(run_.workers()) {
  built_.seconds.clear();
} catch (const std::bad_alloc&) {
  out_of_memory();
}

void FairSolver::start_anew() {
  recent_.forget();
  run_.drop_systems();
}

// Whatever goes wrong on the way leaves nothing half done behind.
template <class Call>
auto FairSolver::guarded(Call&& call) {
  try {
    return call();
  } catch (const std::bad_alloc&) {
    start_anew();
    out_of_memory();
  } catch (...) {
    start_anew();
    throw;
  }
}

void FairSolver::take_place(std::span<const double> coordinates) {
  const std::vector<Vec3>& basis = run_.basis().world;
  bool is_basis = true;
  for (std::size_t i = 0; i < coordinates.size() && is_basis; ++i)
    is_basis = coordinates[i] == basis[i / 3][Eigen::Index(i % 3)];
  const Placement next = is_basis ? run_.basis() : run_.place(coordinates);
  place_ = next;  // copied into the arrays that are there: spans show them
}

Report FairSolver::solve(std::span<const double> coordinates, double* out) {
  if (!coordinates.empty()) check_positions(std::size_t(run_.mesh().input_vertices), coordinates);
  return guarded([&] {
    Report report = built_;
    Stopwatch watch(report, monitor_);
    watch.enter(Phase::hierarchy, 0);
    run_.system();
    watch.enter(Phase::curves, 0);
    if (!coordinates.empty()) take_place(coordinates);
    const bool constrained =
        run_.options().interpolation == Interpolation::approximate && run_.options().tolerance > 0;
    report.warm = !recent_.empty() && !constrained && solve_on(watch, report);
    if (!report.warm) solve_afresh(watch, report);
    write(watch, report, out);
    watch.leave();
    monitor_.report(Phase::done, 1);
    return report;
  });
}

void FairSolver::solve_afresh(Stopwatch& watch, Report& report) {
  recent_.forget();
  KeptRun::Solved solved = run_.solve(place_, recent_.surface(), watch, [&](const double* start) {
    if (!run_.options().measure) return;
    watch.enter(Phase::measure, 0.2);
    report.prediction = run_.energies(start);
    watch.enter(Phase::solve, 0.25);
  });
  report.levels = std::move(solved.levels);
  report.curvature = std::move(solved.curvature);
  report.constraint_rounds = solved.constraint_rounds;
  report.constraint_gap = solved.constraint_gap;
  recent_.took(place_.working);
}

// From the last surface; false where that does not go well.
bool FairSolver::solve_on(Stopwatch& watch, Report& report) {
  watch.enter(Phase::solve, 0);
  std::unique_ptr<CurvatureSystem>& curved = run_.curved();
  if (curved && !curved->can_move()) return false;
  run_.take(place_);
  if (curved) curved->leave_plate(recent_.surface());
  recent_.foresee(place_.working);
  const double asked = run_.options().relative_residual;
  run_.system().solve_moved(recent_.foreseen(), place_.working,
                            curved ? std::max(asked, start_tolerance) : asked, recent_.surface(),
                            report.levels, [&](const double* start) {
                              if (!run_.options().measure) return;
                              watch.enter(Phase::measure, 0.2);
                              report.prediction = run_.energies(start);
                              watch.enter(Phase::solve, 0.25);
                            });
  recent_.took(place_.working);
  if (!curved) return true;
  CurvatureLevelReport& steps = report.curvature.emplace_back();
  if (curved->solve_moved(recent_.surface(), run_.mirrors_of(place_), steps)) return true;
  report.levels.clear();
  report.curvature.clear();
  return false;
}

void FairSolver::write(Stopwatch& watch, Report& report, double* out) {
  warn_unconverged(report.levels.back(), run_.options(), "", report);
  const double* x = run_.curved() ? run_.curved()->surface().data() : recent_.surface().data();
  if (run_.options().epsilon > 0 && !run_.curved()) {
    released_ = recent_.surface();
    report.constraint_rounds += run_.release(place_, watch, released_);
    x = released_.data();
  }
  if (run_.options().measure) {
    watch.enter(Phase::measure, 0.9);
    report.result = run_.energies(x);
    report.polyhedron = run_.polyhedron_energies(place_);
  } else {
    report.result = report.polyhedron = report.prediction = {NAN, NAN};
  }
  watch.enter(Phase::output, 0.95);
  to_world(place_, run_.finest(), run_.frame(), run_.workers(), x, out);
  report.largest_deviation = largest_deviation(place_.world, run_.mesh().input_vertices, out);
  report.peak_bytes = ledger_.peak();
}

void FairSolver::rebase(const PolygonMesh& input) {
  Report report = built_;
  {
    Stopwatch watch(report, monitor_);
    check_positions(std::size_t(run_.mesh().input_vertices), input.coordinates);
    run_.check(input, watch, report);
    guarded([&] {
      recent_.forget();
      run_.rebase(input.coordinates, watch);
      place_ = run_.basis();
    });
  }
  report.seconds.clear();
  built_ = std::move(report);
}

}  // namespace fairing
