// SPDX-License-Identifier: GPL-3.0-or-later
#include "fairing/control_positions.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <utility>

#include "base/error.h"
#include "base/points.h"
#include "base/roundoff.h"
#include "mesh/validate/check.h"
#include "mesh/vertex_pair.h"

namespace fairing {
namespace {

// Affine weights of the corners that give a split polygon's centre: of all such weights those with
// the least sum of squares, 1/n + (c_k - m) . S^-1 (centre - m), where m is the corners' mean and S
// = sum (c_k - m)(c_k - m)^T. Returns the centre of `shape` by these weights.
Vec3 centre_of_shape(const ControlMesh& mesh, std::span<const Vec3> basis, Index centre,
                     std::span<const Vec3> shape) {
  std::vector<Index> corners;
  for (const Spoke& spoke : mesh.ring(centre)) corners.push_back(mesh.end_of(spoke));
  const auto count = double(corners.size());
  Vec3 mean = Vec3::Zero();
  for (const Index c : corners) mean += basis[c] / count;
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  for (const Index c : corners) {
    const Vec3 offset = basis[c] - mean;
    spread += offset * offset.transpose();
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(spread);
  const Vec3 along = axes.eigenvectors().transpose() * (basis[centre] - mean);
  // The extent across a flat polygon is rounding and is ignored. An eigenvalue is a squared extent:
  // below a millionth of the polygon's length it counts as flat.
  Vec3 scaled = Vec3::Zero();
  for (int a = 0; a < 3; ++a)
    if (axes.eigenvalues()[a] > roundoff * axes.eigenvalues()[2])
      scaled[a] = along[a] / axes.eigenvalues()[a];
  const Vec3 slope = axes.eigenvectors() * scaled;
  Vec3 result = Vec3::Zero();
  for (const Index c : corners) result += (1 / count + slope.dot(basis[c] - mean)) * shape[c];
  return result;
}

ControlPositions in_both_systems(const ControlMesh& mesh, std::vector<Vec3> world,
                                 FeatureCurves curves, const Frame& frame) {
  ControlPositions control;
  control.cage.assign(world.begin(), world.begin() + mesh.input_vertices);
  for (const Vec3& p : world) control.working.push_back(frame.to_working(p));
  control.world = std::move(world);
  control.world_curves = std::move(curves);
  control.working_curves = control.world_curves;
  for (Vec3& p : control.working_curves.points) p = frame.to_working(p);
  return control;
}

// Replaces a chain's points by those that the caller of a piece has given. `surface`: 0 for the
// mesh, s + 1 for shape s.
void set_handed(const ControlMesh& mesh, const HandedCurves& handed, std::size_t surface,
                FeatureCurves& curves) {
  const auto inner = std::size_t(curves.points_per_edge);
  const std::size_t size = 3 * inner * handed.edges.size();
  if (size == 0 ? !handed.points.empty()
                : handed.points.size() % size || handed.points.size() / size <= surface)
    throw FairingError(ErrorCode::bad_shape, "Curves of the whole have points of another level.");
  std::vector<std::pair<VertexPair, std::size_t>> place;
  for (std::size_t k = 0; k < handed.edges.size(); ++k)
    place.push_back({ascending(handed.edges[k][0], handed.edges[k][1]), k});
  std::sort(place.begin(), place.end());
  for (Index e = 0; e < mesh.first_copied_edge() && !place.empty(); ++e) {
    if (curves.run[e] < 0) continue;
    const Index from = mesh.original_vertex(mesh.edges[e].vertex[0]),
                to = mesh.original_vertex(mesh.edges[e].vertex[1]);
    const VertexPair pair = ascending(from, to);
    const auto at = std::lower_bound(place.begin(), place.end(), std::pair(pair, std::size_t(0)));
    if (at == place.end() || at->first != pair) continue;
    const double* points = handed.points.data() + surface * size + 3 * inner * at->second;
    Vec3* own = curves.points.data() + std::size_t(curves.run[e]) * inner;
    const bool along = handed.edges[at->second][0] == from;
    for (std::size_t k = 0; k < inner; ++k)
      own[along ? k : inner - 1 - k] = Eigen::Map<const Vec3>(points + 3 * k);
  }
}

void require_numbers(std::span<const double> coordinates, const std::string& where) {
  const std::vector<std::int64_t> bad = non_finite_vertices(coordinates);
  if (!bad.empty())
    throw FairingError(
        ErrorCode::non_finite,
        {where + "{vertex} {has|have} a coordinate that is NaN, infinite or beyond 1e100.",
         "Move them."},
        bad);
}

}  // namespace

Frame working_frame(const ControlMesh& mesh, std::span<const Vec3> world) {
  Frame frame;
  Vec3 low = Vec3::Constant(INFINITY), high = -low;
  for (Index v = 0; v < mesh.vertex_count(); ++v) {
    if (mesh.ring(v).empty()) continue;  // isolated vertices do not extend the range of coordinates
    low = low.cwiseMin(world[v]);
    high = high.cwiseMax(world[v]);
  }
  const Vec3 centre = 0.5 * low + 0.5 * high;
  const double size = (high - low).maxCoeff();
  if (!centre.allFinite() || !(size > 0)) return frame;
  frame.centre = centre;
  frame.scale = std::exp2(std::floor(std::log2(size)));
  return frame;
}

ControlPositions positions_of_mesh(const ControlMesh& mesh, std::vector<Vec3> world,
                                   const Frame& frame, const CurveScheme& scheme,
                                   const HandedCurves& handed) {
  FeatureCurves curves = refine_feature_edges(mesh, world, world, scheme);
  set_handed(mesh, handed, 0, curves);
  return in_both_systems(mesh, std::move(world), std::move(curves), frame);
}

std::vector<Vec3> all_positions(const ControlMesh& mesh, std::span<const Vec3> basis_world,
                                std::span<const double> coordinates) {
  std::vector<Vec3> world;
  for (Index v = 0; v < mesh.input_vertices; ++v) world.push_back(point_at(coordinates, v));
  for (const Index v : mesh.copies.vertex) world.push_back(world[v]);
  for (Index c = mesh.first_centre(); c < mesh.vertex_count(); ++c)
    world.push_back(centre_of_shape(mesh, basis_world, c, world));
  return world;
}

ControlPositions positions_of_shape(const ControlMesh& mesh, std::span<const Vec3> basis_world,
                                    std::span<const double> coordinates, const Frame& frame,
                                    const CurveScheme& scheme, const HandedCurves& handed,
                                    std::size_t shape) {
  std::vector<Vec3> world = all_positions(mesh, basis_world, coordinates);
  FeatureCurves curves = refine_feature_edges(mesh, basis_world, world, scheme);
  if (!handed.edges.empty()) set_handed(mesh, handed, shape + 1, curves);
  return in_both_systems(mesh, std::move(world), std::move(curves), frame);
}

void check_shapes(const PolygonMesh& mesh, std::span<const double> shapes) {
  const std::size_t size = mesh.coordinates.size();
  if (shapes.size() % size != 0)
    throw FairingError(ErrorCode::bad_shape,
                       "shapes must be (k, n, 3): k positions of every vertex.");
  for (std::size_t s = 0; s * size < shapes.size(); ++s)
    require_numbers(shapes.subspan(s * size, size), "In shape " + std::to_string(s) + " ");
}

void check_positions(std::size_t vertices, std::span<const double> coordinates) {
  if (coordinates.size() != 3 * vertices)
    throw FairingError(ErrorCode::bad_shape, {std::to_string(coordinates.size() / 3) +
                                                  " vertices where the solver's mesh has " +
                                                  std::to_string(vertices) + ".",
                                              "Make another solver."});
  require_numbers(coordinates, "");
}

}  // namespace fairing
