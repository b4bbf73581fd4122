// SPDX-License-Identifier: GPL-3.0-or-later
#include "fairing/problem.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <type_traits>
#include <utility>

#include "base/error.h"
#include "base/points.h"
#include "base/roundoff.h"
#include "fairing/checked.h"
#include "fairing/memory_plan.h"
#include "fairing/settings.h"
#include "fairing/warnings.h"
#include "grid/accumulate.h"
#include "mesh/flat_faces.h"
#include "mesh/validate/check.h"
#include "parallel/cancel.h"
#include "stencil/weights.h"

namespace fairing {
namespace {

// Whether control vertex v is an unknown of the solve. A vertex where sheets touch is fixed, since
// each sheet would move it differently.
bool control_vertex_moves(const ControlMesh& mesh, const FairOptions& options, Index v) {
  if (v >= mesh.first_centre()) return true;
  if (mesh.fans_meet(v)) return false;
  const auto original = std::size_t(mesh.original_vertex(v));
  return options.tolerance_of(original) > 0 &&
         (options.weights.empty() || std::isfinite(options.weights[original]));
}

// Inside the region: free and weighted control vertices, and all points off feature curves. May
// throw FairingError(cancelled).
Unknowns choose_unknowns(const ControlMesh& mesh, const FairOptions& options) {
  Unknowns u;
  u.vertex.assign(std::size_t(mesh.vertex_count()), 0);
  for (const Index v : Cancellable(mesh.vertex_count())) {
    const bool on_curve = mesh.feature_vertex[v] || mesh.ring(v).empty();
    const bool moves = control_vertex_moves(mesh, options, v);
    u.vertex[v] = moves && !on_curve && mesh.vertex_part(v) == RegionPart::inside;
    u.any_vertex |= bool(u.vertex[v]);
  }
  u.edge.resize(mesh.edges.size());
  for (std::size_t e = 0; e < mesh.edges.size(); ++e)
    u.edge[e] = !mesh.feature_edge[e] && mesh.edge_part(Index(e)) == RegionPart::inside;
  for (const RegionPart part : mesh.region.face) u.face.push_back(part == RegionPart::inside);
  return u;
}

// Throws FairingError(underdetermined), naming the vertices, if a component has neither a fixed nor
// a weighted control vertex: any single point would be its fairest surface. `weights`: per control
// vertex, or empty.
void require_anchored(const ControlMesh& mesh, const Unknowns& unknowns,
                      const VertexWeights& weights) {
  const auto anchored = [&](std::size_t v) {
    return !unknowns.vertex[v] || (!weights.empty() && weights[v] > 0);
  };
  // All vertices that are connected to anchors by edges are held.
  std::vector<std::uint8_t> held(std::size_t(mesh.vertex_count()), 0);
  std::vector<Index> front;
  for (std::size_t v = 0; v < held.size(); ++v)
    if (anchored(v)) {
      held[v] = 1;
      front.push_back(Index(v));
    }
  for (std::size_t step = 0; !front.empty(); ++step) {
    stop_if_cancelled(step);
    const Index v = front.back();
    front.pop_back();
    for (const Spoke& spoke : mesh.ring(v)) {
      const Index other = mesh.end_of(spoke);
      if (held[other]) continue;
      held[other] = 1;
      front.push_back(other);
    }
  }
  std::vector<std::int64_t> loose;
  for (std::size_t v = 0; v < std::size_t(mesh.input_vertices); ++v)
    if (!held[v]) loose.push_back(std::int64_t(v));
  if (!loose.empty())
    throw FairingError(
        ErrorCode::underdetermined,
        {"Nothing holds the part of the mesh around vertex " + std::to_string(loose[0]) + ".",
         "Give a vertex of it a weight, or interpolate one."},
        loose);
}

// Size of a run, including `held` and the memory of mending.
RunSize size_of(const PolygonMesh& input, const FairOptions& options, std::int64_t held) {
  RunSize size = predict_size(input.vertex_count(), input.corners, input.offsets,
                              options.shape_count(input.coordinates.size()), options);
  size.bytes += std::min(held, std::numeric_limits<std::int64_t>::max() - size.bytes);
  size.bytes = std::max(size.bytes, std::int64_t(MemoryLedger::highest()));
  return size;
}

// Units of the whole mesh if this is a piece of it.
MeshUnits units_in_working(const FairingProblem& problem) {
  const OfWhole& whole = problem.options.whole;
  return whole.given ? in_lengths_of(whole.units, problem.frame.scale, problem.exponent)
                     : measure_units(problem.mesh, problem.exponent);
}

// Stencils measure it in the mean edge of their own mesh.
MembraneOptions membrane_of(const FairingProblem& problem) {
  MembraneOptions out = problem.options.membrane;
  if (problem.options.whole.given)
    out.edge_ratio = measure_units(problem.mesh, problem.exponent).edge / problem.units.edge;
  return out;
}

// Largest distance of two positions in working coordinates that count as the same: rounding in the
// caller's computation at the mesh's size, and some units in the last place of world coordinates.
double same_place(const Frame& frame) {
  const double place = std::numeric_limits<double>::epsilon() * frame.centre.norm() / frame.scale;
  return roundoff + 8 * place;
}

// Corners and ends of chains need no test of their own, since they change the curves.
bool mirrors_curves(const ControlMesh& mesh, const Mirror& mirror, const FeatureCurves& curves,
                    double tolerance) {
  const auto count = std::size_t(curves.points_per_edge);
  for (std::size_t e = 0; e < mesh.edges.size(); ++e) {
    if (curves.run[e] < 0) continue;
    if (curves.run[mirror.edge[e]] < 0) return false;
    const auto points = curves.of(Index(e)), opposite = curves.of(mirror.edge[e]);
    const bool reversed = mirror.reverses(mesh, Index(e));
    for (std::size_t k = 0; k < count; ++k) {
      const Vec3& image = opposite[reversed ? count - 1 - k : k];
      if ((mirror.plane.image(points[k]) - image).norm() > tolerance) return false;
    }
  }
  return true;
}

bool mirrors_values(const ControlMesh& mesh, const Mirror& mirror,
                    const std::vector<double>& values) {
  for (std::size_t v = 0; v < values.size(); ++v) {
    const Index image = mesh.original_vertex(mirror.vertex[v]);
    if (!mesh.ring(Index(v)).empty() && values[v] != values[image]) return false;
  }
  return true;
}

// Whether images have equal numbers in all settings of one number a vertex.
bool mirrors_settings(const ControlMesh& mesh, const Mirror& mirror, const FairOptions& options) {
  bool out = options.tolerance.size() == 1 || mirrors_values(mesh, mirror, options.tolerance);
  for_each_setting([&](const char*, auto range, auto... member) {
    if constexpr (std::is_same_v<decltype(range), PerVertex>)
      out = out && mirrors_values(mesh, mirror, (options.*....*member));
  });
  return out;
}

// `world`: one position a control vertex; `cage`: the caller's. Sets working coordinates.
void make_about(std::vector<Vec3> world, std::vector<Vec3> cage, Stopwatch& watch,
                FairingProblem& problem) {
  const FairOptions& options = problem.options;
  ControlMesh& mesh = problem.mesh;
  watch.enter(Phase::curves, 0);
  problem.frame = working_frame(mesh, world);
  problem.basis = positions_of_mesh(mesh, std::move(world), problem.frame, options.curve_scheme(),
                                    options.whole.curves);
  problem.basis.cage = std::move(cage);

  watch.enter(Phase::hierarchy, 0);
  mesh.positions = problem.basis.working;  // the mesh is complete: stencils are made of it
  problem.normals = choose_normals(mesh, options);
  require_near(mesh, problem.normals.fixed);
  set_upright(mesh, problem.basis, problem.normals);
  problem.units = units_in_working(problem);
  problem.stencils =
      make_stencils(mesh, *problem.charts(), options.paper, *problem.workers, membrane_of(problem));
  problem.symmetry = find_symmetry(mesh, same_place(problem.frame), [&](const Mirror& mirror) {
    return mirrors_settings(mesh, mirror, options) &&
           mirrors_curves(mesh, mirror, problem.basis.working_curves, same_place(problem.frame));
  });
  problem.start_weights =
      problem.constraints_of(problem.basis, problem.units.weight).start_weights();
  require_anchored(mesh, problem.unknowns, problem.start_weights);
}

}  // namespace

void check_input(const PolygonMesh& input, const FairOptions& options, Stopwatch& watch,
                 Report& report) {
  watch.enter(Phase::check, 0);
  check_mesh(input, options, report);
}

std::unique_ptr<const FairingProblem> make_problem(const PolygonMesh& input,
                                                   const FairOptions& options, Stopwatch& watch,
                                                   Report& report) {
  const auto held = std::int64_t(MemoryLedger::held());
  watch.enter(Phase::check, 0);
  check_options(input, options);
  check_input(input, options, watch, report);
  check_shapes(input, options.shapes);
  const RunSize size = size_of(input, options, held);
  require_fit(size, options);
  report.predicted_bytes = std::size_t(size.bytes);
  expect_memory(report);

  watch.enter(Phase::hierarchy, 0);
  auto workers = std::make_shared<Workers>(options.threads);
  report.threads = workers->count();
  auto problem = std::make_unique<FairingProblem>(
      FairingProblem{options,
                     std::move(workers),
                     make_control_mesh(input, options.features, report.flipped_faces),
                     options.curve_scheme().exponent,
                     {},
                     {}});
  if (options.interpolation == Interpolation::exact) hold_flat_parts(problem->mesh);
  report.sheets = sheets_of(problem->mesh);
  problem->unknowns = choose_unknowns(problem->mesh, options);
  const auto& given = problem->mesh.positions;
  std::vector<Vec3> cage(given.begin(), given.begin() + problem->mesh.input_vertices);
  HeldMesh held_mesh = held_positions(input, problem->mesh, options);
  problem->held = std::move(held_mesh.rule);
  make_about(std::move(held_mesh.world), std::move(cage), watch, *problem);
  return problem;
}

std::unique_ptr<const FairingProblem> make_problem_about(const PolygonMesh& input,
                                                         const FairingProblem& like,
                                                         Stopwatch& watch) {
  auto problem = std::make_unique<FairingProblem>(
      FairingProblem{like.options, like.workers, like.mesh, like.exponent, like.unknowns, {}});
  problem->held = like.held;
  check_held(like.held, input, like.options.repair);
  ControlPositions next = like.control_positions(input.coordinates);
  make_about(std::move(next.world), std::move(next.cage), watch, *problem);
  return problem;
}

ControlPositions FairingProblem::control_positions(std::span<const double> coordinates) const {
  return about(coordinates, {}, 0);
}

ControlPositions FairingProblem::shape_positions(std::size_t shape) const {
  const std::size_t size = 3 * std::size_t(mesh.input_vertices);
  return about(options.shapes.subspan(shape * size, size), options.whole.curves, shape);
}

ControlPositions FairingProblem::about(std::span<const double> coordinates,
                                       const HandedCurves& handed, std::size_t shape) const {
  ControlPositions control = positions_of_shape(mesh, basis.world, held.of(coordinates), frame,
                                                options.curve_scheme(), handed, shape);
  for (std::size_t v = 0; v < control.cage.size(); ++v)
    control.cage[v] = point_at(coordinates, Index(v));
  return control;
}

Symmetry FairingProblem::symmetry_of(const ControlPositions& control) const {
  const double tolerance = same_place(frame);
  return symmetry.kept([&](const Mirror& mirror) {
    return mirrors_positions(mesh, mirror, control.working, tolerance) &&
           mirrors_curves(mesh, mirror, control.working_curves, tolerance);
  });
}

std::vector<double> FairingProblem::working_tolerances() const {
  std::vector<double> out;
  for (Index v = 0; v < mesh.first_centre(); ++v)
    out.push_back(options.tolerance_of(std::size_t(mesh.original_vertex(v))) / frame.scale);
  return out;
}

std::vector<double> FairingProblem::weights_with_copies() const {
  std::vector<double> out = options.weights;
  if (!out.empty())
    for (const Index v : mesh.copies.vertex) out.push_back(out[v]);
  return out;
}

}  // namespace fairing
