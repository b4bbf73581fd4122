// SPDX-License-Identifier: GPL-3.0-or-later
#include "fairing/problem.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "fairing/memory_plan.h"
#include "fairing/unknowns.h"
#include "fairing/warnings.h"
#include "hold/hold_in_space.h"
#include "mesh/sheets.h"
#include "mesh/validate/check.h"

namespace fairing {
namespace {

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

// Of a run, as far as it can be counted, `held` and what mending took included.
RunSize size_of(const FairingProblem& problem, std::size_t coordinates, std::int64_t held) {
  const FairOptions& options = problem.options;
  RunSize size =
      predict_size(problem.mesh, problem.unknowns, options.levels, options.shape_count(coordinates),
                   options.energy, options.tension > 0, options.paper.method == Method::back_leg);
  for (const std::int64_t more :
       {held, std::int64_t(Couples::bytes(problem.mesh, problem.normals.fixed))})
    size.bytes += std::min(more, std::numeric_limits<std::int64_t>::max() - size.bytes);
  size.bytes = std::max(size.bytes, std::int64_t(MemoryLedger::highest()));
  return size;
}

// `world`: one position a control vertex. From here on the mesh itself is in working coordinates.
void make_about(std::vector<Vec3> world, Stopwatch& watch, FairingProblem& problem) {
  const FairOptions& options = problem.options;
  ControlMesh& mesh = problem.mesh;
  watch.enter(Phase::curves, 0);
  problem.frame = working_frame(mesh, world);
  problem.basis = positions_of_mesh(mesh, std::move(world), problem.frame, 1 << options.levels,
                                    problem.exponent);

  watch.enter(Phase::hierarchy, 0);
  mesh.positions = problem.basis.working;
  require_near(mesh, problem.normals.fixed);
  const std::unique_ptr<ChartMaker> charts = problem.charts();
  problem.stencils = make_stencils(mesh, *charts, options.paper, *problem.workers,
                                   membrane_strength(options.tension));
  if (options.energy != Energy::thin_plate)
    problem.mirrors = find_symmetry(mesh, problem.basis, problem.frame, options);
  problem.weight_unit = weight_unit(mesh, charts->flat());
  problem.start_weights =
      problem.hold_of<HoldInSpace>(problem.basis, problem.weight_unit).weights();
  require_anchored(mesh, problem.unknowns, problem.start_weights);
}

}  // namespace

void check_input(const PolygonMesh& input, const FairOptions& options, Stopwatch& watch,
                 Report& report) {
  watch.enter(Phase::check, 0);
  CheckResult checked = check(input, {options.repair == Repair::mend});
  if (options.energy != Energy::thin_plate) require_two_sides(checked.warnings);
  report.warnings = std::move(checked.warnings);
  report.flipped_faces = std::move(checked.flipped_faces);
}

std::unique_ptr<const FairingProblem> make_problem(const PolygonMesh& input,
                                                   const FairOptions& options, Stopwatch& watch,
                                                   Report& report) {
  const auto held = std::int64_t(MemoryLedger::held());
  watch.enter(Phase::check, 0);
  check_options(input, options);
  check_input(input, options, watch, report);
  check_shapes(input, options.shapes);
  require_fit(input, options);

  watch.enter(Phase::hierarchy, 0);
  auto workers = std::make_shared<Workers>(options.threads);
  report.threads = workers->count();
  auto problem = std::make_unique<FairingProblem>(
      FairingProblem{options,
                     std::move(workers),
                     make_control_mesh(input, options.features, report.flipped_faces),
                     options.paper.metric_exponent(options.metric_exponent),
                     {},
                     {}});
  report.sheets = sheets_of(problem->mesh);
  problem->unknowns = choose_unknowns(problem->mesh, options);
  problem->normals = choose_normals(problem->mesh, options);
  const RunSize size = size_of(*problem, input.coordinates.size(), held);
  require_fit(size, options);
  report.predicted_bytes = std::size_t(size.bytes);
  expect_memory(report);
  make_about(problem->mesh.positions, watch, *problem);
  return problem;
}

std::unique_ptr<const FairingProblem> make_problem_about(std::span<const double> coordinates,
                                                         const FairingProblem& like,
                                                         Stopwatch& watch) {
  auto problem = std::make_unique<FairingProblem>(FairingProblem{
      like.options, like.workers, like.mesh, like.exponent, like.unknowns, like.normals});
  make_about(like.control_positions(coordinates).world, watch, *problem);
  return problem;
}

ControlPositions FairingProblem::control_positions(std::span<const double> coordinates) const {
  return positions_of_shape(mesh, basis.world, coordinates, frame, 1 << options.levels, exponent);
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
    for (const Index v : mesh.copied_vertex) out.push_back(out[std::size_t(v)]);
  return out;
}

}  // namespace fairing
