// SPDX-License-Identifier: GPL-3.0-or-later
#include "fairing/warnings.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <string_view>
#include <utility>
#include <vector>

#include "base/points.h"
#include "constraints/control_constraints.h"
#include "fairing/fixed_normals.h"
#include "grid/thickness.h"
#include "mesh/vertex_pair.h"
#include "parallel/expected_memory.h"

namespace fairing {

void expect_memory(const Report& report) { expect_memory(report.predicted_bytes); }

void warn_of_memory(const MemoryLedger& ledger, Report& report) {
  report.peak_bytes = ledger.peak();
  const std::size_t predicted = report.predicted_bytes;
  if (predicted == 0 || report.peak_bytes <= std::max(predicted + predicted / 10, small_run))
    return;
  char text[200];
  std::snprintf(text, sizeof text,
                "This took %.3g MB; %.3g MB were predicted. Some levels proved hard.",
                double(report.peak_bytes) / 1e6, double(predicted) / 1e6);
  report.warnings.push_back({"MEMORY_EXCEEDED", text, {}, ElementKind::mesh});
}

namespace {

constexpr std::string_view thickness_changed = "THICKNESS_CHANGED", bulges = "BULGES";

template <class... Parts>
Warning warning(const char* code, const char* cure, const char* format, Parts... parts) {
  char cause[300];
  std::snprintf(cause, sizeof cause, format, parts...);
  return {code, {cause, cure}, {}, ElementKind::mesh};
}

Warning of_tolerance(int level, double gap) {
  return warning("NOT_CONVERGED_TOLERANCE",
                 "The surface is usable; a smaller tolerance settles sooner.",
                 "On level %d the tolerance is kept, but the energy may be %.1e above the least "
                 "one, relative.",
                 level, gap);
}

Warning of_plate(const LevelReport& level, const FairOptions& options) {
  if (level.constraint_gap > gap_wanted) return of_tolerance(level.level, level.constraint_gap);
  if (level.normal_angle > std::numbers::pi / 2)
    return warning("NOT_CONVERGED_TURNED_OVER",
                   "Turn that normal towards the faces around it, or free it.",
                   "On level %d the surface is flipped at a fixed normal: it points up to %.3g "
                   "degrees away.",
                   level.level, level.normal_angle / degree);
  if (level.normal_angle > largest_angle_left)
    return warning(
        "NOT_CONVERGED_NORMALS",
        "The surface is usable; fewer normals, or nearer to the mesh's own, settle sooner.",
        "On level %d fixed normals have not settled after %d corrections: up to %.2g degrees are "
        "left.",
        level.level, level.pad_corrections, level.normal_angle / degree);
  if (level.pad_corrections > 0 && level.residual <= options.solve.relative_residual)
    return warning("NOT_CONVERGED_PADS",
                   "The surface is usable; a smaller pad_size settles sooner.",
                   "On level %d the loads on pads have not settled after %d corrections: %.1e of "
                   "them is still changing.",
                   level.level, level.pad_corrections, level.pad_force);
  return warning("NOT_CONVERGED", "The surface is usable.",
                 "On level %d the solver stopped after %d iterations at a relative residual of "
                 "%.1e (target: %.1e).",
                 level.level, level.iterations, level.residual, options.solve.relative_residual);
}

Warning of_steps(const Report& surface, const FairOptions& options) {
  const CurvatureLevelReport& level = surface.curvature.back();
  if (level.swollen)
    return warning(
        "NOT_CONVERGED_SWOLLEN",
        "You get the thin plate's surface. Use energy=\"thin_plate\", tension or "
        "interpolation=\"limit\".",
        "On level %d most of the surface would swell to many times the thickness of the control "
        "mesh, or turn inside out, and steps would not settle soon.",
        level.level);
  if (level.kept_start)
    return warning("NOT_CONVERGED_START", "Use fewer levels or the thin plate.",
                   "On level %d the steps made the surface worse, so their start was kept.",
                   level.level);
  if (level.constraint_gap > gap_wanted) return of_tolerance(level.level, level.constraint_gap);
  if (!std::isfinite(level.left))
    return warning(
        "NOT_CONVERGED", "Use fewer levels or the thin plate.",
        "On level %d no step made the surface fairer, and the distance from the solution "
        "is unknown.",
        level.level);
  const bool has_swollen = std::any_of(
      surface.warnings.begin(), surface.warnings.end(),
      [](const Warning& told) { return told.code == thickness_changed || told.code == bulges; });
  return warning("NOT_CONVERGED",
                 has_swollen ? "Use energy=\"thin_plate\"."
                             : "The surface is usable; more steps or fewer levels come nearer.",
                 "On level %d the steps stopped after %zu at about %.1e of the mesh's size "
                 "from the solution (target: %.1e).",
                 level.level, level.steps.size(), level.left, options.step_tolerance_wanted());
}

// The cures that are not in use yet. Tension reduces swelling, and creases the lift by sharp edges
// (measured: a wing with caps, 18 times as thick; exact with creases). Hollows form where long faces
// span a tight turn; a smaller exponent of lengths makes them more even (measured: a wing, with
// 0.25), while tension would make them deeper. Limit positions cure both (measured: a phone case, a
// bevelled box and a fish).
std::string cure_of_thickness(const FairOptions& options, bool is_thicker) {
  std::vector<std::string> cures;
  if (options.energy != Energy::thin_plate) cures.push_back("{setting:energy=\"thin_plate\"}");
  if (!is_thicker && options.metric_exponent > 0.25)
    cures.push_back("{setting:metric_exponent=0.25}");
  if (is_thicker && options.energy != Energy::minimum_variation && options.membrane.tension < 1)
    cures.push_back("more {setting:tension}");
  if (options.interpolation == Interpolation::exact)
    cures.push_back("{setting:interpolation=\"limit\"}");
  if (is_thicker) cures.push_back("{setting:creases} where it turns");
  cures.push_back("more {setting:vertices} there");
  std::string text = "Use " + cures[0];
  for (std::size_t i = 1; i < cures.size(); ++i)
    text += (i + 1 < cures.size() ? ", " : " or ") + cures[i];
  return text + ".";
}

}  // namespace

void warn_straightened(const ControlMesh& mesh, const std::vector<Index>& edges, Report& report) {
  std::vector<VertexPair> ends;
  for (const Index e : edges) {
    const auto& v = mesh.edges[e].vertex;
    ends.push_back(ascending(mesh.original_vertex(v[0]), mesh.original_vertex(v[1])));
  }
  if (ends.empty()) return;
  std::sort(ends.begin(), ends.end());
  ends.erase(std::unique(ends.begin(), ends.end()), ends.end());
  std::vector<std::int64_t> ids;
  for (const VertexPair& pair : ends) ids.insert(ids.end(), pair.begin(), pair.end());
  report.warnings.push_back({"STRAIGHT_CURVE",
                             {"{edge} {is|are} straight where a border or crease is a curve: it "
                              "would leave them by more than the faces there are wide.",
                              "Add vertices along the curve, or widen these faces."},
                             ids,
                             ElementKind::edge});
}

void warn_of_thickness(const GridLevel& grid, Workers& workers, const double* x,
                       const double* subdivided, const FairOptions& options, Report& report) {
  if (grid.n() == 1) return;  // that of the control mesh
  const ControlMesh& mesh = grid.mesh();
  std::vector<Vec3> control;
  for (Index v = 0; v < mesh.vertex_count(); ++v) control.push_back(point_at(x, v));
  // What an energy makes of flats is seen early on closed bodies.
  const bool of_flats = std::none_of(mesh.edges.begin(), mesh.edges.end(),
                                     [](const Edge& edge) { return edge.boundary(); });
  const ThicknessChange change =
      Thickness(mesh, control, workers).of(grid, workers, x, of_flats, subdivided);
  const auto add = [&](std::string_view code, const char* cause, const std::vector<Index>& faces,
                       bool is_thicker) {
    std::vector<std::int64_t> polygons;
    for (const Index f : faces) polygons.push_back(mesh.faces[f].polygon);
    if (polygons.empty()) return;
    std::sort(polygons.begin(), polygons.end());
    polygons.erase(std::unique(polygons.begin(), polygons.end()), polygons.end());
    report.warnings.push_back({std::string(code),
                               {cause, cure_of_thickness(options, is_thicker)},
                               polygons,
                               ElementKind::face});
  };
  char cause[120] = "{face} {has|have} a surface that has passed through the opposite side.";
  if (change.worst > -1)
    std::snprintf(cause, sizeof cause,
                  "{face} {has|have} a surface that is up to %.3g times as thick as the %s.",
                  1 + change.worst, subdivided ? "subdivided mesh" : "mesh");
  add(thickness_changed, cause, change.faces, change.worst > 0);
  add(bulges, "{face} {has|have} a surface that bulges farther than they are wide.", change.bulging,
      true);
}

void warn_unconverged(const FairOptions& options, Report& report) {
  if (report.converged()) return;
  report.warnings.push_back(report.curvature.empty() ? of_plate(report.levels.back(), options)
                                                     : of_steps(report, options));
}

}  // namespace fairing
