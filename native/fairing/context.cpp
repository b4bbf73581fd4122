// SPDX-License-Identifier: GPL-3.0-or-later
#include "fairing/context.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>
#include <utility>

#include "curvature/total_curvature.h"
#include "fairing/extremes.h"
#include "fairing/memory_plan.h"
#include "fairing/output.h"
#include "fairing/unknowns.h"
#include "fairing/warnings.h"
#include "grid/linear.h"
#include "hold/hold_in_space.h"
#include "mesh/sheets.h"
#include "mesh/validate/check.h"
#include "paper/back_leg.h"
#include "paper/charts.h"
#include "paper/release.h"
#include "parallel/cancel.h"

namespace fairing {
namespace {

PadReport report_of(const Pads& pads, std::size_t vertices, double unit) {
  PadReport out;
  for (std::size_t v = 0; v < vertices; ++v) {
    out.widths.push_back(pads.under(v) ? unit * pads.reach(v) : 0.0);
    out.narrower += pads.under(v) && !pads.is_whole(v);
    out.gone += pads.began_under(v) && !pads.under(v);
  }
  return out;
}

SheetReport sheets_of(const ControlMesh& mesh) {
  SheetReport out;
  const SheetNumbers sheets = number_sheets(mesh);
  out.count = std::size_t(sheets.count);
  std::vector<std::uint8_t> one_sided(std::size_t(mesh.vertex_count()), 0);
  for (Index f = mesh.first_copied_face(); f < Index(mesh.faces.size()); ++f)
    one_sided[std::size_t(sheets.of_vertex[std::size_t(mesh.faces[std::size_t(f)].vertex[0])])] = 1;
  out.one_sided = std::size_t(std::count(one_sided.begin(), one_sided.end(), 1));
  std::vector<std::uint8_t> on_edge(std::size_t(mesh.input_vertices), 0);
  for (Index e = 0; e < mesh.first_copied_edge(); ++e) {
    if (!mesh.nonmanifold(e)) continue;
    ++out.nonmanifold_edges;
    for (const Index v : mesh.edges[std::size_t(e)].vertex)
      on_edge[std::size_t(mesh.original_vertex(v))] = 1;
  }
  for (Index v = 0; v < mesh.input_vertices; ++v)
    out.nonmanifold_vertices += mesh.fans_meet(v) && !on_edge[std::size_t(v)];
  return out;
}

void require_two_sides(const std::vector<Warning>& warnings) {
  for (const Warning& warning : warnings)
    if (warning.code == name(ErrorCode::non_orientable))
      throw FairingError(ErrorCode::non_orientable,
                         listing(face_s, warning.elements, {"belongs", "belong"}) +
                             " to a surface with only one side, like a Möbius strip. Only the thin "
                             "plate takes it: for the other energies a surface needs normals that "
                             "agree all over. Use energy=\"thin_plate\", or cut it open.",
                         warning.elements);
}

}  // namespace

FairingContext::FairingContext(const PolygonMesh& input, const FairOptions& options,
                               Monitor& monitor, Stopwatch& watch, Report& report)
    : options_(options), monitor_(monitor) {
  const CancelScope scope(&monitor);
  const auto mended_bytes = std::int64_t(MemoryLedger::held());
  watch.enter(Phase::check, 0);
  check_options(input, options_);
  check(input, watch, report);
  check_shapes(input, options_.shapes);
  require_fit(input, options_);

  watch.enter(Phase::hierarchy, 0);
  workers_ = std::make_unique<Workers>(options_.threads);
  report.threads = workers_->count();
  mesh_ = make_control_mesh(input, options_.features, report.flipped_faces);
  report.sheets = sheets_of(mesh_);
  unknowns_ = choose_unknowns(mesh_, options_);
  RunSize size = predict_size(mesh_, unknowns_, options_.levels,
                              options_.shape_count(input.coordinates.size()), options_.energy,
                              options_.tension > 0, options_.paper.method == Method::back_leg);
  const auto add_bytes = [&](std::int64_t more) {  // as far as they can be counted
    size.bytes += std::min(more, std::numeric_limits<std::int64_t>::max() - size.bytes);
  };
  add_bytes(mended_bytes);
  normals_ = choose_normals(mesh_, options_);
  add_bytes(std::int64_t(Couples::bytes(mesh_, normals_.fixed)));
  // What mending took in passing.
  size.bytes = std::max(size.bytes, std::int64_t(MemoryLedger::highest()));
  require_fit(size, options_);
  report.predicted_bytes = std::size_t(size.bytes);
  expect_memory(report);
  exponent_ = options_.paper.metric_exponent(options_.metric_exponent);
  build(mesh_.positions, watch);
}

void FairingContext::check(const PolygonMesh& input, Stopwatch& watch, Report& report) const {
  watch.enter(Phase::check, 0);
  CheckResult checked = fairing::check(input, {options_.repair == Repair::mend});
  if (options_.energy != Energy::thin_plate) require_two_sides(checked.warnings);
  report.warnings = std::move(checked.warnings);
  report.flipped_faces = std::move(checked.flipped_faces);
}

void FairingContext::rebase(std::span<const double> coordinates, Stopwatch& watch,
                            ControlPositions& control) {
  std::vector<Vec3> world = control_positions(coordinates).world;
  std::vector<Vec3> positions = mesh_.positions;
  drop_systems();
  // From here on nothing fails but what is put back: all that build() sets.
  std::tuple before(frame_, std::move(basis_), std::move(stencils_), std::move(mirrors_),
                    weight_unit_, std::move(start_weights_), std::move(positions));
  try {
    build(std::move(world), watch);
    ControlPositions copy = basis_;
    control = std::move(copy);
  } catch (...) {
    drop_systems();
    std::tie(frame_, basis_, stencils_, mirrors_, weight_unit_, start_weights_, mesh_.positions) =
        std::move(before);
    throw;
  }
}

template <class Hold>
Hold FairingContext::hold_of(const ControlPositions& control, double unit) const {
  if (options_.interpolation == Interpolation::exact)
    return Hold(mesh_, control.working, unknowns_);
  return Hold(mesh_, control.working, unknowns_, weights_with_copies(), unit, working_tolerances());
}

// `world`: one position a control vertex. From here on the mesh itself is in working coordinates.
void FairingContext::build(std::vector<Vec3> world, Stopwatch& watch) {
  watch.enter(Phase::curves, 0);
  frame_ = working_frame(mesh_, world);
  basis_ = positions_of_mesh(mesh_, std::move(world), frame_, 1 << options_.levels, exponent_);

  watch.enter(Phase::hierarchy, 0);
  mesh_.positions = basis_.working;
  require_near(mesh_, normals_.fixed);
  stencils_ = make_stencils(mesh_, *charts(), options_.paper, *workers_,
                            membrane_strength(options_.tension));
  mirrors_ = options_.energy == Energy::thin_plate ? std::vector<Mirror>{}
                                                   : find_symmetry(mesh_, basis_, frame_, options_);
  weight_unit_ = weight_unit(mesh_, flatten(mesh_, exponent_));
  start_weights_ = hold_of<HoldInSpace>(basis_, weight_unit_).weights();
  require_anchored(mesh_, unknowns_, start_weights_);
  system();
}

ControlPositions FairingContext::control_positions(std::span<const double> coordinates) const {
  return positions_of_shape(mesh_, basis_.world, coordinates, frame_, 1 << options_.levels,
                            exponent_);
}

std::unique_ptr<ChartMaker> FairingContext::charts() const {
  return make_charts(mesh_, exponent_, options_.paper);
}

ThinPlateSolver& FairingContext::system() {
  if (!system_) {
    has_adapted_ = false;
    ThinPlateOptions options;
    options.levels = options_.levels;
    options.relative_residual = options_.relative_residual;
    options.max_iterations = options_.max_iterations;
    options.smoother_degree = options_.smoother_degree;
    options.pad_size = options_.width_of_pads();
    options.normals = normals_.fixed;
    options.starts_steps = options_.energy != Energy::thin_plate;
    system_ =
        std::make_unique<ThinPlateSolver>(mesh_, basis_.working_curves, *charts(), stencils_,
                                          unknowns_, start_weights_, options, *workers_, monitor_);
  }
  return *system_;
}

void FairingContext::drop_systems() {
  gauss_newton_.reset();
  system_.reset();
}

std::vector<double> FairingContext::working_tolerances() const {
  std::vector<double> out;
  for (Index v = 0; v < mesh_.first_centre(); ++v)
    out.push_back(options_.tolerance_of(std::size_t(mesh_.original_vertex(v))) / frame_.scale);
  return out;
}

std::vector<double> FairingContext::weights_with_copies() const {
  std::vector<double> out = options_.weights;
  if (!out.empty())
    for (const Index v : mesh_.copied_vertex) out.push_back(out[std::size_t(v)]);
  return out;
}

std::unique_ptr<GaussNewtonSolver> FairingContext::make_gauss_newton(
    const ControlPositions& control) {
  if (options_.energy == Energy::thin_plate || system().base() > options_.levels) return nullptr;
  std::vector<CurvatureGrid> levels;
  for (int l = 0; l <= options_.levels; ++l)
    levels.push_back({&system().grid(l), system().transfer_matrix(l)});
  GaussNewtonOptions options;
  if (options_.energy == Energy::minimum_variation)
    options.energy = CurvatureEnergy::minimum_variation;
  const double length = mean_edge(mesh_, flatten(mesh_, 1));
  options.tension = membrane_strength(options_.tension) / (length * length);
  options.step_tolerance = options_.step_tolerance_wanted();
  options.load_tolerance = std::clamp(5 * options_.relative_residual, 1e-4, 2e-3);
  options.max_steps = options_.max_steps;
  options.max_iterations = options_.max_iterations;
  options.smoother_degree = options_.smoother_degree;
  return std::make_unique<GaussNewtonSolver>(
      mesh_, levels, system().base(), stencils_, unknowns_, options,
      hold_of<HoldAlongNormals>(control, weight_unit(mesh_)), system().pads(), mirrors_of(control),
      *workers_, monitor_);
}

void FairingContext::solve(const ControlPositions& control, bool measured, Stopwatch& watch,
                           Report& report, Array<double>& x) {
  watch.enter(Phase::solve, 0);
  system().take_shape(control.working_curves, start_weights_, !has_adapted_);
  has_adapted_ = true;
  gauss_newton_.reset();
  gauss_newton_ = make_gauss_newton(control);
  HoldInSpace hold = hold_of<HoldInSpace>(control, weight_unit_);
  const auto on_prediction = [&](const double* start) {
    if (measured) measure_prediction(start, watch, report);
  };
  const auto on_level = [&](int level, Array<double>& points) {
    if (gauss_newton_) report.curvature.push_back(gauss_newton_->solve_level(level, points));
  };
  if (options_.paper.method == Method::back_leg)
    solve_back_leg(*system_, control.working, options_.paper.sweeps, x, report.levels,
                   on_prediction);
  else
    system_->solve_nested(control.working, x, report.levels, on_prediction, on_level,
                          hold.active() ? &hold : nullptr);
  for (const LevelReport& level : report.levels)
    report.constraint_rounds += level.constraint_rounds;
  report.constraint_gap = report.levels.back().constraint_gap;
  for (const CurvatureLevelReport& level : report.curvature) {
    for (const StepReport& step : level.steps) report.constraint_rounds += step.constraint_rounds;
    report.constraint_gap = level.constraint_gap;
  }
  report_held(report);
}

void FairingContext::report_held(Report& report) {
  const Pads* const pads =
      gauss_newton_ && gauss_newton_->pads() ? gauss_newton_->pads() : system().pads();
  if (pads) report.pads = report_of(*pads, std::size_t(mesh_.input_vertices), frame_.scale);
  report_normals(normals_, report.levels.back(), report);
}

void FairingContext::move_surface(Array<double>& x) {
  if (!gauss_newton_) return;
  std::swap(x, gauss_newton_->surface());
  gauss_newton_.reset();
}

void FairingContext::release(const ControlPositions& control, Stopwatch& watch, Report& report,
                             Array<double>& x) {
  if (!(options_.paper.epsilon > 0) || options_.energy != Energy::thin_plate) return;
  watch.enter(Phase::constrain, 0.8);
  report.constraint_rounds += release_control_vertices(system(), mesh_, control.working,
                                                       options_.paper.epsilon / frame_.scale, x);
}

// The energy of working coordinates in the unit of world ones.
SurfaceEnergies FairingContext::energies(const double* x) {
  SurfaceEnergies e;
  e.thin_plate = std::pow(frame_.scale, 2 - 2 * exponent_) * system().bending(options_.levels, x);
  e.total_curvature = options_.measure ? total_curvature(finest(), *workers_, x) : NAN;
  return e;
}

void FairingContext::measure_prediction(const double* start, Stopwatch& watch, Report& report) {
  watch.enter(Phase::measure, 0.2);
  report.prediction = energies(start);
  watch.enter(Phase::solve, 0.25);
}

void FairingContext::write(const ControlPositions& control, bool measured, Stopwatch& watch,
                           Report& report, const double* x, double* world) {
  if (measured) {
    watch.enter(Phase::measure, 0.9);
    report.result = energies(x);
    Array<double> polyhedron(3 * finest().size());
    refine_linearly(finest(), control.working, *workers_, polyhedron.data());
    report.polyhedron = energies(polyhedron.data());
  } else {
    report.result = report.polyhedron = report.prediction = {NAN, NAN};
  }
  watch.enter(Phase::output, 0.95);
  to_world(control, finest(), frame_, *workers_, x, world);
  require_finite(mesh_, control, *workers_, 3 * finest().size(), world);
  report.largest_deviation = largest_deviation(control.world, mesh_.input_vertices, world);
}

}  // namespace fairing
