// SPDX-License-Identifier: GPL-3.0-or-later
#include "fair/fair.h"

#include <cmath>
#include <new>
#include <string>

#include "check/check.h"
#include "energy/total_curvature.h"
#include "execution/cancel.h"
#include "execution/vectors.h"
#include "fair/anchored.h"
#include "fair/back_leg.h"
#include "fair/check_options.h"
#include "fair/constrain.h"
#include "fair/curvature.h"
#include "fair/frame.h"
#include "fair/memory_plan.h"
#include "fair/output.h"
#include "fair/placement.h"
#include "fair/stopwatch.h"
#include "fair/surface.h"
#include "lattice/linear.h"

namespace fairing {
namespace {

// Everything that moves: inside the region, control vertices that are free or weighted, and points off the curves.
Unknowns choose_unknowns(const ControlMesh& mesh, const FairOptions& options) {
  Unknowns u;
  u.vertex.assign(std::size_t(mesh.vertex_count()), 0);
  for (Index v = 0; v < mesh.vertex_count(); ++v) {
    stop_if_cancelled(std::size_t(v));
    const bool on_curve = mesh.feature_vertex[std::size_t(v)] || mesh.ring(v).empty();
    const bool moves = v >= mesh.input_vertices || control_vertex_moves(options, v);
    u.vertex[std::size_t(v)] = moves && !on_curve && mesh.vertex_place(v) == Place::inside;
    u.any_vertex |= bool(u.vertex[std::size_t(v)]);
  }
  u.edge.resize(mesh.edges.size());
  for (std::size_t e = 0; e < mesh.edges.size(); ++e)
    u.edge[e] = !mesh.feature_edge[e] && mesh.edge_place(Index(e)) == Place::inside;
  for (const Place place : mesh.region.face) u.face.push_back(place == Place::inside);
  return u;
}

// The surface leaves in the caller's coordinates; whatever has not moved comes back to the last bit.
void to_world(const ControlMesh& mesh, const Placement& place, const Lattice& lattice, const Frame& frame,
              Workers& workers, Array<double>& x) {
  const std::vector<Vec3>& given = place.world;
  std::vector<std::uint8_t> kept(given.size());
  for (std::size_t v = 0; v < given.size(); ++v) {
    stop_if_cancelled(v);
    kept[v] = Vec3(x[3 * v], x[3 * v + 1], x[3 * v + 2]) == place.working[v];
  }
  for_each_index(workers, x.size(),
                 [&](std::size_t i) { x[i] = frame.centre[Eigen::Index(i % 3)] + frame.scale * x[i]; });
  for (std::size_t v = 0; v < given.size(); ++v)
    if (kept[v])
      for (std::size_t a = 0; a < 3; ++a) x[3 * v + a] = given[v][Eigen::Index(a)];
  for (std::size_t e = 0; e < mesh.edges.size(); ++e) {
    if (place.world_curves.run[e] < 0) continue;
    const auto points = place.world_curves.of(Index(e));
    for (std::size_t k = 0; k < points.size(); ++k)
      for (std::size_t a = 0; a < 3; ++a)
        x[3 * (std::size_t(lattice.edge_base(Index(e))) + k) + a] = points[k][Eigen::Index(a)];
  }
  refine_outside_linearly(lattice, given, x.data());
}

double largest_deviation(const std::vector<Vec3>& given, Index input_vertices, const Array<double>& x) {
  double largest = 0;
  for (std::size_t v = 0; v < std::size_t(input_vertices); ++v)
    largest = std::max(largest, (Vec3(x[3 * v], x[3 * v + 1], x[3 * v + 2]) - given[v]).norm());
  return largest;
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

// What the surfaces of a run have in common.
struct Solver {
  const ControlMesh& mesh;
  const FairOptions& options;
  const Frame& frame;
  SurfaceSystem& system;
  Stopwatch& watch;
  const Stencils& stencils;
  const std::vector<Mirror>& mirrors;

  std::vector<CurvatureLevelReport> curvature{};

  // One surface in working coordinates; the reports of its levels.
  std::vector<LevelReport> solve(const Placement& place, ToleranceConstraint& constraint, Array<double>& x,
                                 const std::function<void(const double*)>& on_prediction) {
    std::vector<LevelReport> levels;
    watch.enter(Phase::solve, 0);
    curvature.clear();
    std::unique_ptr<CurvatureSystem> curved = make_curved(place);
    const auto on_level = [&](int level, Array<double>& points) {
      if (constraint.active()) {
        watch.enter(Phase::constrain, 0.5);
        constraint.settle(system, level, points);
        if (level == options.levels)
          levels.back() = constraint.finish(system, options.relative_residual, points);
        watch.enter(Phase::solve, 0.5);
      }
      if (curved) curvature.push_back(curved->solve_level(level, points));
    };
    if (options.method == Method::back_leg)
      solve_back_leg(system, place.working, options.sweeps, x, levels, on_prediction);
    else
      system.solve_nested(place.working, x, levels, on_prediction, on_level);
    if (curved && system.base() <= options.levels) std::swap(x, curved->surface());
    return levels;
  }

  std::unique_ptr<CurvatureSystem> make_curved(const Placement& place) {
    if (options.energy == Energy::thin_plate || system.base() > options.levels) return nullptr;
    std::vector<const Lattice*> lattices;
    for (int l = 0; l <= options.levels; ++l) lattices.push_back(&system.lattice(l));
    const Unknowns& unknowns = system.shared().unknowns;
    return std::make_unique<CurvatureSystem>(
        mesh, lattices, system.base(), stencils, unknowns, options,
        ControlHold(mesh, place.working, unknowns, options, options.tolerance / frame.scale),
        options.epsilon / frame.scale, kept_by(place, mesh, frame, mirrors), system.shared().workers,
        system.monitor());
  }

  // Returns the solves taken.
  int release(const Placement& place, Array<double>& x) {
    if (!(options.epsilon > 0) || options.energy != Energy::thin_plate) return 0;
    watch.enter(Phase::constrain, 0.8);
    return release_control_vertices(system, mesh, place.working, options.epsilon / frame.scale, x);
  }
};

// The number of an earlier surface with the same control positions, 0 for the mesh itself; -1: none.
std::ptrdiff_t same_before(const PolygonMesh& input, std::span<const double> shapes, std::size_t shape) {
  const std::size_t size = input.coordinates.size();
  const auto own = shapes.subspan(shape * size, size);
  for (std::size_t s = 0; s <= shape; ++s) {  // surface s + 1 is shape s
    const auto earlier = s == 0 ? input.coordinates : shapes.subspan((s - 1) * size, size);
    if (std::equal(own.begin(), own.end(), earlier.begin())) return std::ptrdiff_t(s);
  }
  return -1;
}

FairResult run(const PolygonMesh& input, const FairOptions& options, Monitor& monitor) {
  MemoryLedger ledger;
  const CancelScope scope(&monitor);
  FairResult result;
  Report& report = result.report;
  Stopwatch watch(report, monitor);

  watch.enter(Phase::check, 0);
  check_options(input, options);
  CheckResult checked = check(input, {options.repair_orientation});
  report.warnings = std::move(checked.warnings);
  report.flipped_faces = checked.flipped_faces;
  check_shapes(input, options.shapes);
  require_fit(input, options);
  const std::size_t shapes = options.shape_count(input.coordinates.size());
  const auto enter_surface = [&](std::size_t s) {  // 0: the mesh itself
    monitor.enter_part(double(s) / double(shapes + 1), double(s + 1) / double(shapes + 1));
  };
  enter_surface(0);

  watch.enter(Phase::hierarchy, 0);
  Workers workers(options.threads);
  report.threads = workers.count();
  ControlMesh mesh = make_control_mesh(input, options.features, checked.flipped_faces);
  const RunSize size = predict_size(mesh, options.levels, shapes, options.energy);
  require_fit(size, options);
  report.predicted_bytes = std::size_t(size.bytes);

  watch.enter(Phase::curves, 0);
  const double exponent = options.chart.kind == ChartKind::tangent ? 1.0 : options.chart.exponent;
  const Frame frame = frame_of(mesh);
  const int subdivisions = 1 << options.levels;
  const Placement basis = place_basis(mesh, frame, subdivisions, exponent);
  std::vector<Placement> shape_places;
  for (std::size_t s = 0; s < shapes; ++s)
    shape_places.push_back(
        place_shape(mesh, options.shapes.subspan(s * input.coordinates.size(), input.coordinates.size()),
                    frame, subdivisions, exponent));

  watch.enter(Phase::hierarchy, 0);
  mesh.positions = basis.working;
  const Stencils stencils = make_stencils(mesh, options.chart, workers);
  const std::vector<Mirror> mirrors = options.energy == Energy::thin_plate
                                          ? std::vector<Mirror>{}
                                          : find_symmetry(mesh, basis, frame, options);
  const double energy_unit = std::pow(frame.scale, 2 - 2 * exponent);

  Array<double> x;
  {
    const Unknowns unknowns = choose_unknowns(mesh, options);
    const double unit = weight_unit(mesh, flatten(mesh, exponent));
    const auto constraint_of = [&](const Placement& place) {
      return ToleranceConstraint(mesh, place.working, unknowns, options, unit,
                                 options.tolerance / frame.scale);
    };
    ToleranceConstraint constraint = constraint_of(basis);
    const VertexWeights start_weights = constraint.start_weights();
    require_anchored(mesh, unknowns, start_weights);
    SurfaceSystem system(mesh, basis.working_curves, stencils, unknowns, start_weights, options, workers,
                         monitor);
    Solver solver{mesh, options, frame, system, watch, stencils, mirrors};
    const Lattice& finest = system.lattice(options.levels);
    const auto energies = [&](const double* points) {
      SurfaceEnergies e;
      e.thin_plate = energy_unit * system.energy(options.levels, points);
      e.total_curvature = options.measure ? total_curvature(finest, workers, points) : NAN;
      return e;
    };

    report.levels = solver.solve(basis, constraint, x, [&](const double* start) {
      watch.enter(Phase::measure, 0.2);
      report.prediction = energies(start);
      watch.enter(Phase::solve, 0.25);
    });
    report.curvature = solver.curvature;
    warn_unconverged(report.levels.back(), options, "", report);
    report.constraint_rounds = constraint.rounds();
    report.constraint_gap = constraint.gap();
    report.constraint_rounds += solver.release(basis, x);

    watch.enter(Phase::measure, 0.9);
    report.result = energies(x.data());
    {
      Array<double> polyhedron(x.size());
      refine_linearly(finest, mesh.positions, workers, polyhedron.data());
      report.polyhedron = energies(polyhedron.data());
    }

    watch.enter(Phase::output, 0.95);
    to_world(mesh, basis, finest, frame, workers, x);
    report.largest_deviation = largest_deviation(basis.world, mesh.input_vertices, x);

    for (std::size_t s = 0; s < shapes; ++s) {
      enter_surface(s + 1);
      const std::ptrdiff_t same = same_before(input, options.shapes, s);
      if (same == 0) {
        result.shapes.push_back(x);
        report.shapes.push_back({report.levels.back(), report.largest_deviation, 0});
        continue;
      }
      if (same > 0) {
        result.shapes.push_back(result.shapes[std::size_t(same) - 1]);
        report.shapes.push_back(report.shapes[std::size_t(same) - 1]);
        continue;
      }
      const Placement& place = shape_places[s];
      ToleranceConstraint own = constraint_of(place);
      system.take_shape(place.working_curves, start_weights);
      Array<double>& points = result.shapes.emplace_back();
      ShapeReport& shape = report.shapes.emplace_back();
      shape.finest = solver.solve(place, own, points, {}).back();
      warn_unconverged(shape.finest, options, "Shape " + std::to_string(s) + ": ", report);
      shape.constraint_rounds = own.rounds() + solver.release(place, points);
      watch.enter(Phase::output, 0.95);
      to_world(mesh, place, finest, frame, workers, points);
      shape.largest_deviation = largest_deviation(place.world, mesh.input_vertices, points);
    }
  }
  monitor.enter_part(0, 1);
  const Lattice finest(mesh, options.levels);
  OutputFaces faces = make_faces(finest, workers);
  result.vertices = std::move(x);
  result.triangles = std::move(faces.triangles);
  result.quads = std::move(faces.quads);
  result.triangle_polygon = std::move(faces.triangle_polygon);
  result.quad_polygon = std::move(faces.quad_polygon);
  result.crease_edges = crease_edges(mesh);
  report.peak_bytes = ledger.peak();
  watch.leave();
  monitor.report(Phase::done, 1);
  return result;
}

}  // namespace

FairResult fair(const PolygonMesh& mesh, const FairOptions& options, Monitor& monitor) {
  try {
    return run(mesh, options, monitor);
  } catch (const std::bad_alloc&) {
    throw FairingError(ErrorCode::out_of_memory, "Out of memory. Use fewer levels, or close other programs.");
  }
}

}  // namespace fairing
