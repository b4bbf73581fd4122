// SPDX-License-Identifier: GPL-3.0-or-later
#include "fair/placement.h"

#include <Eigen/Eigenvalues>

#include "check/arrays.h"
#include "check/error.h"
#include "check/listing.h"

namespace fairing {
namespace {

// The least affine weights that give a split polygon's centre from its corners.
Vec3 centre_of_shape(const ControlMesh& mesh, Index centre, std::span<const Vec3> shape) {
  std::vector<Index> corners;
  for (const Spoke& spoke : mesh.ring(centre))
    corners.push_back(mesh.edges[std::size_t(spoke.edge)].vertex[spoke.outward ? 1 : 0]);
  const double count = double(corners.size());
  Vec3 mean = Vec3::Zero();
  for (const Index c : corners) mean += mesh.positions[std::size_t(c)] / count;
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  for (const Index c : corners) {
    const Vec3 offset = mesh.positions[std::size_t(c)] - mean;
    spread += offset * offset.transpose();
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(spread);
  const Vec3 along = axes.eigenvectors().transpose() * (mesh.positions[std::size_t(centre)] - mean);
  Vec3 scaled = Vec3::Zero();
  for (int a = 0; a < 3; ++a)  // an axis across a flat polygon has no extent, and the centre no part in it
    if (axes.eigenvalues()[a] > 1e-12 * axes.eigenvalues()[2]) scaled[a] = along[a] / axes.eigenvalues()[a];
  const Vec3 slope = axes.eigenvectors() * scaled;
  Vec3 result = Vec3::Zero();
  for (const Index c : corners)
    result += (1 / count + slope.dot(mesh.positions[std::size_t(c)] - mean)) * shape[std::size_t(c)];
  return result;
}

Placement placement(std::vector<Vec3> world, FeatureCurves curves, const Frame& frame) {
  Placement place;
  for (const Vec3& p : world) place.working.push_back(frame.to_working(p));
  place.world = std::move(world);
  place.world_curves = std::move(curves);
  place.working_curves = place.world_curves;
  for (Vec3& p : place.working_curves.points) p = frame.to_working(p);
  return place;
}

}  // namespace

void check_shapes(const PolygonMesh& mesh, std::span<const double> shapes) {
  const std::size_t size = mesh.coordinates.size();
  if (shapes.size() % size != 0)
    throw FairingError(ErrorCode::bad_shape, "shapes must be (k, n, 3): k positions of every vertex.");
  for (std::size_t s = 0; s * size < shapes.size(); ++s) {
    const std::vector<std::int64_t> bad = non_finite_vertices(shapes.subspan(s * size, size));
    if (!bad.empty())
      throw FairingError(ErrorCode::non_finite,
                         "In shape " + std::to_string(s) + " " + listing(vertex_s, bad, {"has", "have"}) +
                             " a coordinate that is NaN, infinite or beyond 1e100. Move them.",
                         bad);
  }
}

void check_positions(std::size_t vertices, std::span<const double> coordinates) {
  if (coordinates.size() != 3 * vertices)
    throw FairingError(ErrorCode::bad_shape, std::to_string(coordinates.size() / 3) +
                                                 " vertices where the solver's mesh has " +
                                                 std::to_string(vertices) + ". Make another solver.");
  const std::vector<std::int64_t> bad = non_finite_vertices(coordinates);
  if (!bad.empty())
    throw FairingError(ErrorCode::non_finite,
                       listing(vertex_s, bad, {"has", "have"}) +
                           " a coordinate that is NaN, infinite or beyond 1e100. Move them.",
                       bad);
}

Placement place_basis(const ControlMesh& mesh, const Frame& frame, int subdivisions, double exponent) {
  return placement(mesh.positions, refine_feature_edges(mesh, subdivisions, exponent), frame);
}

Placement place_shape(const ControlMesh& mesh, std::span<const double> coordinates, const Frame& frame,
                      int subdivisions, double exponent) {
  std::vector<Vec3> world;
  for (std::size_t v = 0; v < std::size_t(mesh.input_vertices); ++v)
    world.emplace_back(coordinates[3 * v], coordinates[3 * v + 1], coordinates[3 * v + 2]);
  for (Index c = mesh.input_vertices; c < mesh.vertex_count(); ++c)
    world.push_back(centre_of_shape(mesh, c, world));
  FeatureCurves curves = refine_feature_edges(mesh, world, subdivisions, exponent);
  return placement(std::move(world), std::move(curves), frame);
}

}  // namespace fairing
