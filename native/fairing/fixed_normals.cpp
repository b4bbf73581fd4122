// SPDX-License-Identifier: GPL-3.0-or-later
#include "fairing/fixed_normals.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>

#include "base/angle.h"
#include "base/error.h"
#include "mesh/normal.h"
#include "parallel/cancel.h"
#include "thin_plate/options.h"

namespace fairing {
namespace {

Vec3 normal_given(const FairOptions& options, std::size_t v) {
  const Eigen::Map<const Vec3> given(options.normals.data() + 3 * v);
  return (given / given.lpNorm<Eigen::Infinity>()).normalized();  // of any length
}

// Input vertices inside chains, not at their ends, where the curve has one tangent.
std::vector<std::uint8_t> smooth_vertices(const ControlMesh& mesh) {
  std::vector<std::uint8_t> out(std::size_t(mesh.input_vertices), 0);
  for (const Chain& chain : mesh.features()) {
    const std::size_t count = chain.vertices.size();
    const auto at = [&](std::size_t k) -> const Vec3& {
      return mesh.positions[chain.vertices[k % count]];
    };
    for (std::size_t k = chain.closed ? 0 : 1; k + (chain.closed ? 0 : 1) < count; ++k) {
      const Vec3 before = at(k) - at(k + count - 1), after = at(k + 1) - at(k);
      out[chain.vertices[k]] =
          !chain.straight || angle_between(before, after) <= largest_angle_left;
    }
  }
  return out;
}

// Whether v lies inside a border curve, where faces meet that the normal can turn.
bool on_smooth_border(const ControlMesh& mesh, Index v) {
  const auto ring = mesh.ring(v);
  if (mesh.interior(v) || ring.size() < 3) return false;
  for (std::size_t s = 0; s < ring.size(); ++s) {
    const bool end = s == 0 || s + 1 == ring.size();
    if ((mesh.feature_edge[ring[s].edge] != 0) != end) return false;
  }
  return true;
}

// The direction in which a border edge leaves v, by the parabola through three points.
Vec3 leaving(const ControlMesh& mesh, const ControlPositions& control, const Spoke& spoke) {
  const Edge& edge = mesh.edges[spoke.edge];
  const auto points = control.working_curves.of(spoke.edge);
  const std::size_t count = points.size() + 1;
  const auto at = [&](std::size_t k) -> Vec3 {
    const std::size_t place = spoke.outward ? k : count - k;
    return place == 0       ? control.working[edge.vertex[0]]
           : place == count ? control.working[edge.vertex[1]]
                            : points[place - 1];
  };
  return (4 * at(1) - at(2) - 3 * at(0)).normalized();
}

}  // namespace

ChosenNormals choose_normals(const ControlMesh& mesh, const FairOptions& options) {
  ChosenNormals out;
  if (options.levels == 0) return out;
  const std::vector<std::uint8_t> smooth =
      options.normals.empty() ? std::vector<std::uint8_t>() : smooth_vertices(mesh);
  for (Index v = 0; v < mesh.input_vertices && !options.normals.empty(); ++v) {
    stop_if_cancelled(std::size_t(v));
    if (!options.has_normal(std::size_t(v)) || mesh.ring(v).empty() ||
        mesh.vertex_part(v) == RegionPart::outside)
      continue;
    const bool holds = (mesh.vertex_fit(v) || (smooth[v] && on_smooth_border(mesh, v))) &&
                       mesh.vertex_part(v) == RegionPart::inside && !mesh.fans_meet(v);
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

void set_upright(const ControlMesh& mesh, const ControlPositions& control, ChosenNormals& normals) {
  for (FixedNormal& fixed : normals.fixed) {
    if (mesh.vertex_fit(fixed.vertex)) continue;
    const auto ring = mesh.ring(fixed.vertex);
    const Vec3 along =
        (leaving(mesh, control, ring.front()) - leaving(mesh, control, ring.back())).normalized();
    const double off = along.dot(fixed.normal);
    fixed.normal = (fixed.normal - off * along).normalized();
    const double lean = std::asin(std::min(std::abs(off), 1.0));
    if (lean <= largest_angle_left || mesh.second_vertex(fixed.vertex)) continue;
    normals.leaning.push_back(mesh.original_vertex(fixed.vertex));
    normals.largest_lean = std::max(normals.largest_lean, lean);
  }
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
  if (!normals.left.empty())
    report.warnings.push_back(
        {"NORMAL_NOT_FIXED",
         "{vertex} {has|have} a normal that is not fixed: on creases, at ends "
         "of curves, and where sheets touch, normals are not used.",
         normals.left, ElementKind::vertex});
  if (!normals.leaning.empty()) {
    char lean[32];
    std::snprintf(lean, sizeof lean, "%.2g", normals.largest_lean / degree);
    report.warnings.push_back(
        {"NORMAL_NOT_FIXED",
         "{vertex} {has|have} a normal that leans along the border, by up to " + std::string(lean) +
             " degrees: the surface has the nearest one at a right angle to it.",
         normals.leaning, ElementKind::vertex});
  }
}

}  // namespace fairing
