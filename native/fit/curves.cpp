// SPDX-License-Identifier: GPL-3.0-or-later
#include "fit/curves.h"

#include <Eigen/Dense>
#include <Eigen/SparseCholesky>
#include <algorithm>
#include <numbers>

#include "base/points.h"
#include "parallel/cancel.h"

namespace fairing {
namespace {

// A plate on springs follows its border over this length, in waves that the springs halve.
const double yield_of_plate = std::numbers::sqrt2 / (2 * std::numbers::pi);

// Halves waves of two control edges, the shortest that the drawn curve can have.
constexpr double weight_across = 1.0 / 16;

// Shares of a side from its first corner, and of the way from it across the face.
struct SidePlace {
  double along, across;
};

// The place (u, v) of a closed face against a side, the inverse of closed_point().
SidePlace beside(bool quad, int side, double u, double v) {
  if (quad) {
    constexpr auto other = [](double t) { return 1 - t; };
    switch (side) {
      case 0: return {u, v};
      case 1: return {v, other(u)};
      case 2: return {other(u), other(v)};
      default: return {other(v), u};
    }
  }
  const double w = 1 - u - v;
  const std::array<double, 3> corner{w, u, v};
  const double first = corner[side], second = corner[(side + 1) % 3], both = first + second;
  return {both > 0 ? second / both : 0, 1 - both};
}

// The share of the way `along` at which a segment is nearest to a point; both from its first end.
double nearest_share(const Vec3& point, const Vec3& along) {
  return std::clamp(point.dot(along) / along.squaredNorm(), 0.0, 1.0);
}

}  // namespace

CurveFit::CurveFit(const FairingProblem& problem, const Scan& scan,
                   std::span<const std::uint8_t> fixed)
    : problem_(problem) {
  const ControlMesh& mesh = problem.mesh;
  moves_.assign(std::size_t(mesh.vertex_count()), 0);
  for (std::size_t e = 0; e < mesh.edges.size(); ++e) {
    if (!mesh.feature_edge[e] || mesh.edge_part(Index(e)) != RegionPart::inside) continue;
    for (const Index v : mesh.edges[e].vertex) {
      const Index own = mesh.original_vertex(v);
      if (own >= mesh.input_vertices || mesh.vertex_part(v) != RegionPart::inside ||
          (!fixed.empty() && fixed[own]))
        continue;
      moves_[v] = any_ = true;
    }
  }
  if (!any_) return;
  find_bends();
  find_borders(scan);
}

void CurveFit::find_bends() {
  const std::vector<Vec3>& place = problem_.basis.working;
  for (const Chain& chain : problem_.mesh.features()) {
    if (chain.straight) continue;
    const std::size_t n = chain.vertices.size();
    const auto at = [&](std::size_t k) { return chain.vertices[k % n]; };
    for (std::size_t k = 0; k + (chain.closed ? 0 : 2) < n; ++k) {
      const std::array<Index, 3> of{at(k), at(k + 1), at(k + 2)};
      const auto length = [&](std::size_t a) { return (place[of[a + 1]] - place[of[a]]).norm(); };
      const double before = length(0), after = length(1), sum = before + after;
      const double square = problem_.units.edge_in_space * problem_.units.edge_in_space;
      bends_.push_back({of,
                        {2 * square / (before * sum), -2 * square / (before * after),
                         2 * square / (after * sum)}});
    }
  }
}

// Border points of the scan that are farther from the drawn border than the reach, measured along the
// drawn faces, are rims of holes. They are left out for good: otherwise the curves move to them step
// by step.
void CurveFit::find_borders(const Scan& scan) {
  const ControlMesh& mesh = problem_.mesh;
  const std::vector<Vec3>& place = problem_.basis.working;
  const auto is_near = [&](const Vec3& point, const Side& side) {
    const Face& face = mesh.faces[side.face];
    const int k = side.local;
    const Vec3& from = place[face.vertex[k]];
    const Vec3 along = place[face.vertex[(k + 1) % face.size]] - from;
    const Vec3 normal = along.cross(place[face.vertex[(k + 2) % face.size]] - from).normalized();
    const Vec3 off = point - from - nearest_share(point - from, along) * along;
    return (off - off.dot(normal) * normal).norm() < reach();
  };
  for (const Vec3& point : scan.border) {
    stop_if_cancelled();
    if (std::any_of(mesh.sides.begin(), mesh.sides.end(),
                    [&](const Side& side) { return is_border(side.edge) && is_near(point, side); }))
      border_.push_back(point);
  }
}

// Gives the equation of a place on edge `e` to the edge's ends.
void CurveFit::add(Index e, double along, double weight, const Eigen::Matrix3d& rows,
                   const Vec3& offset, std::vector<MoveEquations>& equations,
                   bool is_of_border) const {
  const ControlMesh& mesh = problem_.mesh;
  for (const int end : {0, 1}) {
    const Index v = mesh.edges[e].vertex[end];
    if (!moves_[v]) continue;
    const double share = weight * (end == 0 ? 1 - along : along);
    MoveEquations& own = equations[mesh.original_vertex(v)];
    own.add(rows, offset, share);
    if (is_of_border) own.of_border += share;
  }
}

// Uses the feet beside a curve as far as the surface under points of this `weight` follows it, by
// shares of a face, but at least those on cells next to it. (Fewer feet follow the noise, and the
// normals of these cells turn with the curve.)
void CurveFit::add_points(const LevelFit& fit, double weight,
                          std::vector<MoveEquations>& equations) const {
  const Cells& cells = fit.cells();
  const ControlMesh& mesh = problem_.mesh;
  const double n = cells.grid().n(), reach = yield_of_plate / std::pow(weight, 0.25),
               width = std::clamp(reach, 1 / n, 1.0);
  for (const std::size_t s : Cancellable(fit.feet().size())) {
    const Foot& foot = fit.feet()[s];
    const double share = foot.is_used() ? robust_weight(double(foot.offset), fit.spread().rms) : 0;
    if (!(share > 0)) continue;
    const FacePlace place = cells.place(foot.cell, foot.shares);
    const Face& face = mesh.faces[place.face];
    for (int k = 0; k < face.size; ++k) {
      const Side& side = mesh.sides[face.first_side + k];
      if (!mesh.feature_edge[side.edge]) continue;
      const SidePlace at = beside(face.quad(), k, place.i / n, place.j / n);
      if (!(at.across < width)) continue;
      const Vec3 normal = fit.finder().normal_at(foot);
      add(side.edge, side.reversed ? 1 - at.along : at.along, share * (1 - at.across / width),
          normal * normal.transpose(), double(foot.offset) * normal, equations);
    }
  }
}

// Projects the scan's border points perpendicularly to the nearest border edges of the level.
void CurveFit::add_borders(const LevelFit& fit, std::vector<MoveEquations>& equations) const {
  const GridLevel& grid = fit.cells().grid();
  const ControlMesh& mesh = problem_.mesh;
  struct Piece {
    Index edge;
    int first;
    Index from, to;
  };
  std::vector<Piece> pieces;
  for (std::size_t e = 0; e < mesh.edges.size(); ++e)
    if (is_border(Index(e)))
      for (int k = 0; k < grid.n(); ++k)
        pieces.push_back(
            {Index(e), k, grid.edge_point(Index(e), k), grid.edge_point(Index(e), k + 1)});
  const double* const x = fit.surface().data();
  for (const Vec3& point : border_) {
    stop_if_cancelled();
    double least = reach() * reach();
    const Piece* nearest = nullptr;
    double share = 0;
    for (const Piece& piece : pieces) {
      const Vec3 from = point_at(x, piece.from), along = point_at(x, piece.to) - from;
      const double t = nearest_share(point - from, along);
      const double square = (point - from - t * along).squaredNorm();
      if (!(square < least)) continue;
      least = square;
      nearest = &piece;
      share = t;
    }
    if (!nearest) continue;
    const Vec3 from = point_at(x, nearest->from), along = point_at(x, nearest->to) - from;
    const Vec3 tangent = along.normalized();
    const Eigen::Matrix3d across = Eigen::Matrix3d::Identity() - tangent * tangent.transpose();
    const Vec3 offset = point - from - share * along;
    add(nearest->edge, (nearest->first + share) / grid.n(), 1, across, offset, equations, true);
  }
}

// A curve is as stiff as the surface of this `weight`, for it follows the same points. But across the
// surface's border the points of the scan's border alone say where it is, without their noise along
// the normals. (As stiff there, the wheel arch of a fender was .001 off at a noise of .005.)
Eigen::Matrix3d CurveFit::stiffness(const LevelFit& fit, double weight, const Bend& bend,
                                    const MoveEquations& points,
                                    std::span<const Vec3> place) const {
  const double own = points.square.trace() / (weight * stiffness_of_wave);
  Eigen::Matrix3d out = own * Eigen::Matrix3d::Identity();
  if (!(points.of_border > 0)) return out;
  Vec3 normal = Vec3::Zero();
  for (const auto& [cell, corner] : fit.cells().at_point(bend.at[1]))
    normal += fit.finder().corner_normals(cell)[corner];
  const Vec3 across = unit_or_zero((place[bend.at[2]] - place[bend.at[0]]).cross(normal));
  const double own_across =
      points.of_border / (std::max(weight, weight_across) * stiffness_of_wave);
  return out + (own_across - own) * across * across.transpose();
}

// In the frame's unit, one a control vertex; directions without enough points stay.
std::vector<Vec3> CurveFit::moves(const LevelFit& fit, double weight,
                                  const std::vector<MoveEquations>& equations,
                                  std::span<const Vec3> place) const {
  std::vector<int> unknown(equations.size(), -1);
  int count = 0;
  for (std::size_t v = 0; v < equations.size(); ++v)
    if (equations[v].square.trace() > 0) unknown[v] = count++;
  std::vector<Eigen::Triplet<double>> terms;
  Eigen::VectorXd rest(3 * count);
  for (std::size_t v = 0; v < equations.size(); ++v) {
    if (unknown[v] < 0) continue;
    const Eigen::Matrix3d& square = equations[v].square;
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j)
        terms.emplace_back(3 * unknown[v] + i, 3 * unknown[v] + j,
                           square(i, j) + (i == j ? square.trace() / 64 : 0));
      rest[3 * unknown[v] + i] = equations[v].rest[i];
    }
  }
  for (const Bend& bend : bends_) {
    const Eigen::Matrix3d stiff = stiffness(fit, weight, bend, equations[bend.at[1]], place);
    Vec3 bent = Vec3::Zero();
    for (std::size_t k = 0; k < 3; ++k) bent += bend.row[k] * place[bend.at[k]];
    for (std::size_t k = 0; k < 3; ++k) {
      const int row = unknown[bend.at[k]];
      if (row < 0) continue;
      rest.segment<3>(3 * row) -= bend.row[k] * (stiff * bent);
      for (std::size_t m = 0; m < 3; ++m)
        if (const int column = unknown[bend.at[m]]; column >= 0)
          for (int i = 0; i < 3; ++i)
            for (int j = 0; j < 3; ++j)
              terms.emplace_back(3 * row + i, 3 * column + j,
                                 bend.row[k] * bend.row[m] * stiff(i, j));
    }
  }
  Eigen::SparseMatrix<double> matrix(3 * count, 3 * count);
  matrix.setFromTriplets(terms.begin(), terms.end());
  const Eigen::VectorXd found =
      Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>>(matrix).solve(rest);
  std::vector<Vec3> out(equations.size(), Vec3::Zero());
  for (std::size_t v = 0; v < out.size(); ++v)
    if (unknown[v] >= 0) out[v] = found.segment<3>(3 * unknown[v]);
  return out;
}

void CurveFit::move(const LevelFit& fit, double weight, ControlPositions& control) const {
  std::vector<MoveEquations> equations(std::size_t(problem_.mesh.input_vertices));
  add_points(fit, weight, equations);
  add_borders(fit, equations);
  const double scale = problem_.frame.scale;
  std::vector<Vec3> place(std::size_t(problem_.mesh.input_vertices));
  for (std::size_t v = 0; v < place.size(); ++v) place[v] = control.world[v] / scale;
  const std::vector<Vec3> move = moves(fit, weight, equations, place);
  std::vector<double> world(3 * place.size());
  for (std::size_t v = 0; v < place.size(); ++v)
    put_point(control.world[v] + scale * move[v], world.data() + 3 * v);
  control = problem_.control_positions(world);
}

}  // namespace fairing
