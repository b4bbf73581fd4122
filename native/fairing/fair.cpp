// SPDX-License-Identifier: GPL-3.0-or-later
// fair() and FairSolver call the same functions of FairingSystems: solve, write. fair() returns
// each surface; FairSolver keeps it as the next start.
#include "fairing/fair.h"

#include <algorithm>
#include <chrono>
#include <new>
#include <string>
#include <utility>

#include "fairing/extremes.h"
#include "fairing/warnings.h"
#include "parallel/cancel.h"

namespace fairing {
namespace {

// A shape may repeat the mesh or an earlier shape, as unused shape keys do. Returns the number of
// the first surface with the same positions, 0 for the mesh and s + 1 for shape s; -1: none. Given
// curves may differ in spite of equal positions.
std::ptrdiff_t first_equal_surface(const PolygonMesh& input, const FairOptions& options,
                                   std::size_t shape) {
  if (!options.whole.curves.edges.empty()) return -1;
  const std::span<const double> shapes = options.shapes;
  const std::size_t size = input.coordinates.size();
  const auto own = shapes.subspan(shape * size, size);
  for (std::size_t s = 0; s <= shape; ++s) {
    const auto earlier = s == 0 ? input.coordinates : shapes.subspan((s - 1) * size, size);
    if (std::equal(own.begin(), own.end(), earlier.begin())) return std::ptrdiff_t(s);
  }
  return -1;
}

// points <- one surface, in world coordinates, with joined sheets.
void fair_once(FairingSystems& systems, const ControlPositions& control, bool measured,
               Stopwatch& watch, Report& report, Array<double>& points) {
  Surface surface = systems.solve(control, measured, watch, report);
  if (!surface.curved.points.empty()) surface.plate = {};
  systems.write(control, measured, watch, report, surface, surface.points().data());
  points = std::move(surface.points());
  JoinedSheets(systems.finest()).join(points);
}

void fair_shapes(const FairingProblem& problem, FairingSystems& systems, const PolygonMesh& input,
                 Stopwatch& watch, Monitor& monitor, FairResult& result) {
  Report& report = result.report;
  const std::size_t count = problem.options.shape_count(input.coordinates.size());
  for (std::size_t s = 0; s < count; ++s) {
    monitor.enter_part(double(s + 1) / double(count + 1), double(s + 2) / double(count + 1));
    const std::ptrdiff_t same = first_equal_surface(input, problem.options, s);
    if (same == 0) {
      result.shapes.push_back(result.vertices);
      report.shapes.push_back(
          {report.levels.back(), report.converged(), report.largest_deviation, 0});
      continue;
    }
    if (same > 0) {
      result.shapes.push_back(result.shapes[std::size_t(same) - 1]);
      report.shapes.push_back(report.shapes[std::size_t(same) - 1]);
      continue;
    }
    watch.enter(Phase::curves, 0);
    const ControlPositions control = problem.shape_positions(s);
    require_in_reach(problem.mesh, control);
    Report own;
    fair_once(systems, control, false, watch, own, result.shapes.emplace_back());
    const std::string of = "Shape " + std::to_string(s) + ": ";
    for (Warning& warning : own.warnings) {
      warning.message.cause = of + warning.message.cause;
      report.warnings.push_back(std::move(warning));
    }
    report.shapes.push_back({std::move(own.levels.back()), own.converged(), own.largest_deviation,
                             own.constraint_rounds, own.normals.largest_angle});
  }
}

FairResult fair_all(const PolygonMesh& input, const FairOptions& options,
                    const MemoryLedger& ledger, Monitor& monitor) {
  const CancelScope scope(&monitor);
  FairResult result;
  Report& report = result.report;
  Stopwatch watch(report, monitor);
  const std::size_t shapes = options.shape_count(input.coordinates.size());
  monitor.enter_part(0, 1 / double(shapes + 1));
  const std::unique_ptr<const FairingProblem> problem = make_problem(input, options, watch, report);
  FairingSystems systems(*problem, monitor);
  fair_once(systems, problem->basis, true, watch, report, result.vertices);
  fair_shapes(*problem, systems, input, watch, monitor, result);

  monitor.enter_part(0, 1);
  systems.drop();
  finish(*problem, ledger, watch, monitor, result);
  return result;
}

Mending mending_of(const PolygonMesh& input, const FairOptions& options, Monitor& monitor) {
  const CancelScope scope(&monitor);
  monitor.report(Phase::check, 0);
  return Mending(input, options);
}

const FairOptions& without_back_leg(const FairOptions& options) {
  if (options.paper.method == Method::back_leg)
    throw FairingError(
        ErrorCode::bad_option,
        "method=\"back_leg\" keeps nothing to solve again with; use multigrid for a solver.");
  return options;
}

}  // namespace

FairingError out_of_memory() {
  return FairingError(ErrorCode::out_of_memory,
                      {"Out of memory.", "Use fewer levels, or close other programs."});
}

void finish(const FairingProblem& problem, const MemoryLedger& ledger, Stopwatch& watch,
            Monitor& monitor, FairResult& result) {
  result.faces = make_faces(GridLevel(problem.mesh, problem.options.levels), *problem.workers);
  result.crease_edges = crease_edges(problem.mesh);
  warn_of_memory(ledger, result.report);
  watch.leave();
  monitor.report(Phase::done, 1);
}

void restore(const Mending& mending, FairResult& result) {
  mending.restore_points(result.vertices.data());
  for (Array<double>& shape : result.shapes) mending.restore_points(shape.data());
  mending.restore(result.faces);
  mending.restore(result.report);
  if (mending.mended()) result.mended = *mending.mended();
}

FairResult fair(const PolygonMesh& mesh, const FairOptions& options, Monitor& monitor) {
  return with_named_errors([&] {
    const MemoryLedger ledger(options.bytes_allowed());
    const auto begun = std::chrono::steady_clock::now();
    const Mending mending = mending_of(mesh, options, monitor);
    const std::chrono::duration<double> mended_in = std::chrono::steady_clock::now() - begun;
    FairResult result = mending.in_input_ids(
        [&] { return fair_all(mending.mesh(), mending.options(), ledger, monitor); });
    restore(mending, result);
    auto& seconds = result.report.seconds;
    if (options.repair == Repair::mend)
      seconds.insert(seconds.begin(), PhaseSeconds{"mend", mended_in.count()});
    return result;
  });
}

FairSolver::FairSolver(const PolygonMesh& input, const FairOptions& options, Monitor& monitor) try
    : ledger_(options.bytes_allowed()),
      monitor_(monitor),
      build_watch_(built_, monitor_),
      mending_(mending_of(input, without_back_leg(options), monitor_)),
      problem_(mending_.in_input_ids([&] {
        const CancelScope scope(&monitor_);
        return make_problem(mending_.mesh(), mending_.options(), build_watch_, built_);
      })),
      systems_(mending_.in_input_ids([&] {
        const CancelScope scope(&monitor_);
        return std::make_unique<FairingSystems>(*problem_, monitor_, true);
      })),
      control_(problem_->basis),
      recent_(*problem_->workers) {
  built_.seconds.clear();
} catch (const std::bad_alloc&) {
  throw out_of_memory();
}

void FairSolver::forget_surfaces() {
  recent_.forget();
  systems_->drop();
}

// After an error the systems are dropped, so that none is half updated.
template <class Call>
auto FairSolver::guarded(Call&& call) {
  const CancelScope scope(&monitor_);
  try {
    return call();
  } catch (const std::bad_alloc&) {
    forget_surfaces();
    throw out_of_memory();
  } catch (...) {
    forget_surfaces();
    throw;
  }
}

// The positions of the basis give exactly the basis, with its centres and curves.
void FairSolver::set_control(std::span<const double> coordinates) {
  const std::vector<Vec3>& basis = problem_->basis.cage;
  bool is_basis = true;
  for (std::size_t i = 0; i < coordinates.size() && is_basis; ++i)
    is_basis = coordinates[i] == basis[i / 3][i % 3];
  const ControlPositions next =
      is_basis ? problem_->basis : problem_->control_positions(coordinates);
  require_in_reach(problem_->mesh, next);
  control_ = next;  // copied, not moved: solvers refer to the existing arrays
}

Report FairSolver::solve(std::span<const double> coordinates, double* out) {
  return with_named_errors([&] {
    std::vector<double> placed;
    if (mended() && coordinates.size() == 3 * std::size_t(problem_->mesh.input_vertices)) {
      placed = mending_.placed(coordinates);
      coordinates = placed;
    }
    Report report = mending_.in_input_ids([&] { return solve_mended(coordinates, out); });
    mending_.restore_points(out);
    mending_.restore(report);
    return report;
  });
}

Report FairSolver::solve_mended(std::span<const double> coordinates, double* out) {
  if (!coordinates.empty())
    check_positions(std::size_t(problem_->mesh.input_vertices), coordinates);
  return guarded([&] {
    const FairOptions& options = problem_->options;
    if (std::exchange(was_far_out_, false)) forget_surfaces();
    Report report = built_;
    expect_memory(report);
    Stopwatch watch(report, monitor_);
    watch.enter(Phase::hierarchy, 0);
    systems_->plate();
    watch.enter(Phase::curves, 0);
    if (!coordinates.empty()) set_control(coordinates);
    Report unused = built_;
    if (std::optional<Surface> basis = systems_->solve_basis_before(control_, watch, unused))
      recent_.remember(std::move(*basis), systems_->positions_of(problem_->basis));
    report.warm = !recent_.empty() && !options.has_tolerance() && solve_warm(watch, report);
    if (!report.warm) solve_cold(watch, report);
    write(watch, report, out);
    was_far_out_ = lies_far_out(problem_->mesh, control_);
    warn_of_memory(ledger_, report);
    watch.leave();
    monitor_.report(Phase::done, 1);
    return report;
  });
}

void FairSolver::solve_cold(Stopwatch& watch, Report& report) {
  recent_.forget();
  recent_.remember(systems_->solve(control_, problem_->options.measure, watch, report),
                   systems_->positions_of(control_));
}

// False if the solve fails; then it restores the report.
bool FairSolver::solve_warm(Stopwatch& watch, Report& report) {
  if (systems_->solve_moved(control_, recent_, watch, report)) return true;
  report.levels.clear();
  report.curvature.clear();
  return false;
}

void FairSolver::write(Stopwatch& watch, Report& report, double* out) {
  const FairOptions& options = problem_->options;
  const JoinedSheets joined(systems_->finest());
  if (joined.needed()) apart_.resize(3 * systems_->finest().size());
  double* const world = joined.needed() ? apart_.data() : out;
  systems_->write(control_, options.measure, watch, report, recent_.surface(), world);
  if (joined.needed()) joined.join(world, out);
}

OutputFaces FairSolver::faces() {
  return with_named_errors([&] {
    OutputFaces faces = make_faces(systems_->finest(), *problem_->workers);
    mending_.restore(faces);
    return faces;
  });
}

void FairSolver::rebase(const PolygonMesh& input) {
  with_named_errors([&] {
    if (!mended()) return rebase_mended(input);
    const std::vector<double> placed = mending_.placed(input.coordinates);
    const PolygonMesh mesh{placed, mended()->mesh.corners, mended()->mesh.offsets};
    mending_.in_input_ids([&] { rebase_mended(mesh); });
  });
}

void FairSolver::rebase_mended(const PolygonMesh& input) {
  Report report = built_;
  {
    Stopwatch watch(report, monitor_);
    check_positions(std::size_t(problem_->mesh.input_vertices), input.coordinates);
    check_input(input, problem_->options, watch, report);
    guarded([&] {
      forget_surfaces();
      auto problem = make_problem_about(input, *problem_, watch);
      auto systems = std::make_unique<FairingSystems>(*problem, monitor_, true);
      ControlPositions control = problem->basis;
      control_ = std::move(control);
      systems_ = std::move(systems);
      problem_ = std::move(problem);
    });
  }
  report.seconds.clear();
  built_ = std::move(report);
}

Array<std::int32_t> FairSolver::creases() const {
  return with_named_errors([&] { return crease_edges(problem_->mesh); });
}

}  // namespace fairing
