// SPDX-License-Identifier: GPL-3.0-or-later
#include "fair/kept_run.h"

#include <cmath>
#include <cstdio>

#include "check/check.h"
#include "energy/total_curvature.h"
#include "fair/anchored.h"
#include "fair/back_leg.h"
#include "fair/check_options.h"
#include "fair/memory_plan.h"
#include "fair/unknowns.h"
#include "lattice/linear.h"

namespace fairing {

KeptRun::KeptRun(const PolygonMesh& input, const FairOptions& options, Monitor& monitor, Stopwatch& watch,
                 Report& report)
    : options_(options), monitor_(monitor) {
  watch.enter(Phase::check, 0);
  check_options(input, options_);
  check(input, watch, report);
  check_shapes(input, options_.shapes);
  require_fit(input, options_);

  watch.enter(Phase::hierarchy, 0);
  workers_ = std::make_unique<Workers>(options_.threads);
  report.threads = workers_->count();
  mesh_ = make_control_mesh(input, options_.features, report.flipped_faces);
  const RunSize size =
      predict_size(mesh_, options_.levels, options_.shape_count(input.coordinates.size()), options_.energy);
  require_fit(size, options_);
  report.predicted_bytes = std::size_t(size.bytes);
  exponent_ = options_.chart.kind == ChartKind::tangent ? 1.0 : options_.chart.exponent;
  unknowns_ = choose_unknowns(mesh_, options_);
  build(watch);
}

void KeptRun::check(const PolygonMesh& input, Stopwatch& watch, Report& report) const {
  watch.enter(Phase::check, 0);
  CheckResult checked = fairing::check(input, {options_.repair_orientation});
  report.warnings = std::move(checked.warnings);
  report.flipped_faces = std::move(checked.flipped_faces);
}

void KeptRun::rebase(std::span<const double> coordinates, Stopwatch& watch) {
  std::vector<Vec3> world = place(coordinates).world;
  drop_systems();
  mesh_.positions = std::move(world);
  build(watch);
}

// From mesh_ in world coordinates.
void KeptRun::build(Stopwatch& watch) {
  watch.enter(Phase::curves, 0);
  frame_ = frame_of(mesh_);
  basis_ = place_basis(mesh_, frame_, 1 << options_.levels, exponent_);

  watch.enter(Phase::hierarchy, 0);
  mesh_.positions = basis_.working;
  stencils_ = make_stencils(mesh_, options_.chart, *workers_);
  mirrors_ = options_.energy == Energy::thin_plate ? std::vector<Mirror>{}
                                                   : find_symmetry(mesh_, basis_, frame_, options_);
  weight_unit_ = weight_unit(mesh_, flatten(mesh_, exponent_));
  start_weights_ = constraint_of(basis_).start_weights();
  require_anchored(mesh_, unknowns_, start_weights_);
  system();
}

Placement KeptRun::place(std::span<const double> coordinates) {
  // Parameters of curves are taken from world coordinates.
  struct InWorld {
    std::vector<Vec3>&positions, &world;
    InWorld(std::vector<Vec3>& p, std::vector<Vec3>& w) : positions(p), world(w) { positions.swap(world); }
    ~InWorld() { positions.swap(world); }
  } in_world(mesh_.positions, basis_.world);
  return place_shape(mesh_, coordinates, frame_, 1 << options_.levels, exponent_);
}

SurfaceSystem& KeptRun::system() {
  if (!system_) {
    has_adapted_ = false;
    system_ = std::make_unique<SurfaceSystem>(mesh_, basis_.working_curves, stencils_, unknowns_,
                                              start_weights_, options_, *workers_, monitor_);
  }
  return *system_;
}

void KeptRun::drop_systems() {
  curved_.reset();
  system_.reset();
}

ToleranceConstraint KeptRun::constraint_of(const Placement& place) const {
  return ToleranceConstraint(mesh_, place.working, unknowns_, options_, weight_unit_,
                             options_.tolerance / frame_.scale);
}

std::unique_ptr<CurvatureSystem> KeptRun::make_curved(const Placement& place) {
  if (options_.energy == Energy::thin_plate || system().base() > options_.levels) return nullptr;
  std::vector<const Lattice*> lattices;
  for (int l = 0; l <= options_.levels; ++l) lattices.push_back(&system().lattice(l));
  return std::make_unique<CurvatureSystem>(
      mesh_, lattices, system().base(), stencils_, unknowns_, options_,
      ControlHold(mesh_, place.working, unknowns_, options_, options_.tolerance / frame_.scale),
      options_.epsilon / frame_.scale, mirrors_of(place), *workers_, monitor_);
}

KeptRun::Solved KeptRun::solve(const Placement& place, Array<double>& x, Stopwatch& watch,
                               const std::function<void(const double*)>& on_prediction) {
  Solved solved;
  watch.enter(Phase::solve, 0);
  system().take_shape(place.working_curves, start_weights_, !has_adapted_);
  has_adapted_ = true;
  curved_.reset();
  curved_ = make_curved(place);
  ToleranceConstraint constraint = constraint_of(place);
  const auto on_level = [&](int level, Array<double>& points) {
    if (constraint.active()) {
      watch.enter(Phase::constrain, 0.5);
      constraint.settle(*system_, level, points);
      if (level == options_.levels)
        solved.levels.back() = constraint.finish(*system_, options_.relative_residual, points);
      watch.enter(Phase::solve, 0.5);
    }
    if (curved_) solved.curvature.push_back(curved_->solve_level(level, points));
  };
  if (options_.method == Method::back_leg)
    solve_back_leg(*system_, place.working, options_.sweeps, x, solved.levels, on_prediction);
  else
    system_->solve_nested(place.working, x, solved.levels, on_prediction, on_level);
  solved.constraint_rounds = constraint.rounds();
  solved.constraint_gap = constraint.gap();
  return solved;
}

int KeptRun::release(const Placement& place, Stopwatch& watch, Array<double>& x) {
  if (!(options_.epsilon > 0) || options_.energy != Energy::thin_plate) return 0;
  watch.enter(Phase::constrain, 0.8);
  return release_control_vertices(system(), mesh_, place.working, options_.epsilon / frame_.scale, x);
}

SurfaceEnergies KeptRun::energies(const double* x) {
  SurfaceEnergies e;
  e.thin_plate = std::pow(frame_.scale, 2 - 2 * exponent_) * system().energy(options_.levels, x);
  e.total_curvature = options_.measure ? total_curvature(finest(), *workers_, x) : NAN;
  return e;
}

SurfaceEnergies KeptRun::polyhedron_energies(const Placement& place) {
  Array<double> polyhedron(3 * finest().size());
  refine_linearly(finest(), place.working, polyhedron.data());
  return energies(polyhedron.data());
}

void warn_unconverged(const LevelReport& level, const FairOptions& options, const std::string& of,
                      Report& report) {
  if (level.converged) return;
  char text[200];
  std::snprintf(
      text, sizeof text,
      "The solver stopped after %d iterations at a relative residual of %.1e (asked: %.1e). The surface is "
      "usable; very thin faces are the usual cause.",
      level.iterations, level.residual, options.relative_residual);
  report.warnings.push_back({"NOT_CONVERGED", of + text, {}, ElementKind::mesh});
}

Array<std::int32_t> crease_edges(const ControlMesh& mesh) {
  Array<std::int32_t> pairs;
  for (std::size_t e = 0; e < mesh.edges.size(); ++e)
    if (mesh.feature_edge[e] && !mesh.edges[e].boundary())
      pairs.insert(pairs.end(), mesh.edges[e].vertex.begin(), mesh.edges[e].vertex.end());
  return pairs;
}

}  // namespace fairing
