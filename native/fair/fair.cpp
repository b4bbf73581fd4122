// SPDX-License-Identifier: GPL-3.0-or-later
#include "fair/fair.h"

#include <algorithm>
#include <new>
#include <string>

#include "fair/kept_run.h"
#include "fair/world.h"

namespace fairing {
namespace {

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

// What a solve has left in x and in the run's curvature system, in working coordinates.
int finish(KeptRun& run, const Placement& place, Stopwatch& watch, Array<double>& x) {
  if (run.curved()) {
    std::swap(x, run.curved()->surface());
    run.curved().reset();
  }
  return run.release(place, watch, x);
}

void solve_shapes(KeptRun& run, const PolygonMesh& input, const std::vector<Placement>& places,
                  Monitor& monitor, Stopwatch& watch, const Array<double>& basis, FairResult& result) {
  Report& report = result.report;
  for (std::size_t s = 0; s < places.size(); ++s) {
    monitor.enter_part(double(s + 1) / double(places.size() + 1), double(s + 2) / double(places.size() + 1));
    const std::ptrdiff_t same = same_before(input, run.options().shapes, s);
    if (same == 0) {
      result.shapes.push_back(basis);
      report.shapes.push_back({report.levels.back(), report.largest_deviation, 0});
      continue;
    }
    if (same > 0) {
      result.shapes.push_back(result.shapes[std::size_t(same) - 1]);
      report.shapes.push_back(report.shapes[std::size_t(same) - 1]);
      continue;
    }
    const Placement& place = places[s];
    Array<double>& points = result.shapes.emplace_back();
    ShapeReport& shape = report.shapes.emplace_back();
    const KeptRun::Solved solved = run.solve(place, points, watch, {});
    shape.finest = solved.levels.back();
    warn_unconverged(shape.finest, run.options(), "Shape " + std::to_string(s) + ": ", report);
    shape.constraint_rounds = solved.constraint_rounds + finish(run, place, watch, points);
    watch.enter(Phase::output, 0.95);
    to_world(place, run.finest(), run.frame(), run.workers(), points.data(), points.data());
    shape.largest_deviation = largest_deviation(place.world, run.mesh().input_vertices, points.data());
  }
}

FairResult run_once(const PolygonMesh& input, const FairOptions& options, Monitor& monitor) {
  MemoryLedger ledger;
  FairResult result;
  Report& report = result.report;
  Stopwatch watch(report, monitor);
  const std::size_t size = input.coordinates.size(), shapes = options.shape_count(size);
  monitor.enter_part(0, 1 / double(shapes + 1));
  KeptRun run(input, options, monitor, watch, report);

  watch.enter(Phase::curves, 0);
  std::vector<Placement> places;
  for (std::size_t s = 0; s < shapes; ++s)
    places.push_back(run.place(options.shapes.subspan(s * size, size)));

  Array<double> x;
  KeptRun::Solved solved = run.solve(run.basis(), x, watch, [&](const double* start) {
    watch.enter(Phase::measure, 0.2);
    report.prediction = run.energies(start);
    watch.enter(Phase::solve, 0.25);
  });
  report.levels = std::move(solved.levels);
  report.curvature = std::move(solved.curvature);
  warn_unconverged(report.levels.back(), options, "", report);
  report.constraint_rounds = solved.constraint_rounds + finish(run, run.basis(), watch, x);
  report.constraint_gap = solved.constraint_gap;

  watch.enter(Phase::measure, 0.9);
  report.result = run.energies(x.data());
  report.polyhedron = run.polyhedron_energies(run.basis());

  watch.enter(Phase::output, 0.95);
  to_world(run.basis(), run.finest(), run.frame(), run.workers(), x.data(), x.data());
  report.largest_deviation = largest_deviation(run.basis().world, run.mesh().input_vertices, x.data());
  solve_shapes(run, input, places, monitor, watch, x, result);

  monitor.enter_part(0, 1);
  run.drop_systems();
  OutputFaces faces = make_faces(Lattice(run.mesh(), options.levels), run.workers());
  result.vertices = std::move(x);
  result.triangles = std::move(faces.triangles);
  result.quads = std::move(faces.quads);
  result.triangle_polygon = std::move(faces.triangle_polygon);
  result.quad_polygon = std::move(faces.quad_polygon);
  result.crease_edges = crease_edges(run.mesh());
  report.peak_bytes = ledger.peak();
  watch.leave();
  monitor.report(Phase::done, 1);
  return result;
}

}  // namespace

FairResult fair(const PolygonMesh& mesh, const FairOptions& options, Monitor& monitor) {
  try {
    return run_once(mesh, options, monitor);
  } catch (const std::bad_alloc&) {
    throw FairingError(ErrorCode::out_of_memory, "Out of memory. Use fewer levels, or close other programs.");
  }
}

}  // namespace fairing
