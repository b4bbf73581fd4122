// SPDX-License-Identifier: GPL-3.0-or-later
#include "fairing/fixed_normals.h"

#include <Eigen/Geometry>
#include <cmath>

#include "base/angle.h"
#include "base/error.h"
#include "fairing/steepest.h"
#include "mesh/normal.h"
#include "parallel/cancel.h"

namespace fairing {
namespace {

Vec3 normal_given(const FairOptions& options, std::size_t v) {
  const Eigen::Map<const Vec3> given(options.normals.data() + 3 * v);
  return (given / given.lpNorm<Eigen::Infinity>()).normalized();  // of any length
}

}  // namespace

ChosenNormals choose_normals(const ControlMesh& mesh, const FairOptions& options) {
  ChosenNormals out;
  if (options.levels == 0) return out;
  for (Index v = 0; v < mesh.input_vertices && !options.normals.empty(); ++v) {
    stop_if_cancelled(std::size_t(v));
    if (!options.has_normal(std::size_t(v)) || mesh.ring(v).empty() ||
        mesh.vertex_part(v) == RegionPart::outside)
      continue;
    const bool holds =
        mesh.vertex_fit(v) && mesh.vertex_part(v) == RegionPart::inside && !mesh.fans_meet(v);
    if (!holds) {
      out.left.push_back(v);
      continue;
    }
    ++out.vertices;
    const Vec3 normal = normal_given(options, std::size_t(v));
    mesh.for_each_copy(v, [&](Index w) {
      out.fixed.push_back({w, mesh.second_vertex(w) ? Vec3(-normal) : normal});
    });
  }
  return out;
}

void require_near(const ControlMesh& mesh, const std::vector<FixedNormal>& normals) {
  std::vector<std::int64_t> far;
  for (const FixedNormal& fixed : normals) {
    const Vec3 own = control_normal(mesh, fixed.vertex);
    if (own.norm() > 0 && angle_between(own, fixed.normal) > steepest &&
        !mesh.second_vertex(fixed.vertex))
      far.push_back(mesh.original_vertex(fixed.vertex));
  }
  if (!far.empty())
    throw FairingError(ErrorCode::bad_option,
                       {"{vertex} {is|are} to have a normal more than 80 degrees away from that of "
                        "the faces around.",
                        "Turn these normals or these faces, or free the normals."},
                       far, ElementKind::vertex);
}

void report_normals(const ChosenNormals& normals, const LevelReport& finest, Report& report) {
  report.normals.fixed = normals.vertices;
  report.normals.largest_angle = finest.normal_angle / degree;
  if (normals.left.empty()) return;
  report.warnings.push_back({"NORMAL_NOT_FIXED",
                             "{vertex} {has|have} a normal that is not fixed: on curves, and where "
                             "sheets touch, normals are not used.",
                             normals.left, ElementKind::vertex});
}

}  // namespace fairing
