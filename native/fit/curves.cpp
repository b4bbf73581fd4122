// SPDX-License-Identifier: GPL-3.0-or-later
#include "fit/curves.h"

#include <Eigen/Dense>
#include <Eigen/SparseCholesky>

#include "base/points.h"
#include "parallel/cancel.h"

namespace fairing {
namespace {

template <class Visit>
void for_curve_points(const GridLevel& grid, Index e, Visit&& visit) {
  for (int k = 0; k <= grid.n(); ++k) visit(grid.edge_point(e, k), double(k) / grid.n());
}

}  // namespace

CurveFit::CurveFit(const FairingProblem& problem, const Scan& scan,
                   std::span<const std::uint8_t> fixed)
    : problem_(problem), scan_(scan) {
  const ControlMesh& mesh = problem.mesh;
  moves_.assign(std::size_t(mesh.vertex_count()), 0);
  for (std::size_t e = 0; e < mesh.edges.size(); ++e) {
    if (!mesh.feature_edge[e] || mesh.edge_part(Index(e)) != RegionPart::inside) continue;
    for (const Index v : mesh.edges[e].vertex) {
      const Index own = mesh.original_vertex(v);
      if (own >= mesh.input_vertices || mesh.vertex_part(v) != RegionPart::inside ||
          (!fixed.empty() && fixed[std::size_t(own)]))
        continue;
      moves_[std::size_t(v)] = any_ = true;
    }
  }
  if (any_) find_bends();
}

void CurveFit::find_bends() {
  const std::vector<Vec3>& place = problem_.basis.working;
  for (const Chain& chain : problem_.mesh.chains) {
    if (chain.straight) continue;
    const std::size_t n = chain.vertices.size();
    const auto at = [&](std::size_t k) { return chain.vertices[k % n]; };
    for (std::size_t k = 0; k + (chain.closed ? 0 : 2) < n; ++k) {
      const std::array<Index, 3> of{at(k), at(k + 1), at(k + 2)};
      const auto length = [&](std::size_t a) {
        return (place[std::size_t(of[a + 1])] - place[std::size_t(of[a])]).norm();
      };
      const double before = length(0), after = length(1), sum = before + after;
      bends_.push_back({of, {2 * after / sum, -2, 2 * before / sum}});
    }
  }
}

// Uses the feet on cells next to a curve.
std::vector<CurveFit::MoveEquations> CurveFit::equations(const LevelFit& fit) const {
  const Cells& cells = fit.cells();
  const GridLevel& grid = cells.grid();
  const ControlMesh& mesh = problem_.mesh;
  std::vector<std::uint8_t> on_curve(grid.size(), 0);
  for (std::size_t e = 0; e < mesh.edges.size(); ++e)
    if (mesh.feature_edge[e])
      for_curve_points(grid, Index(e), [&](Index p, double) { on_curve[std::size_t(p)] = 1; });
  std::vector<MoveEquations> out(grid.size());
  for (std::size_t s = 0; s < fit.feet().size(); ++s) {
    stop_if_cancelled(s);
    const Foot& foot = fit.feet()[s];
    const double share = foot.is_used() ? robust_weight(double(foot.offset), fit.spread().rms) : 0;
    if (!(share > 0)) continue;
    const auto& corner = cells.corners(foot.cell);
    for (std::size_t k = 0; k < 4; ++k) {
      if (corner[k] < 0 || !on_curve[std::size_t(corner[k])]) continue;
      const Vec3 normal = fit.finder().normal_at(foot);
      out[std::size_t(corner[k])].add(normal * normal.transpose(), double(foot.offset) * normal,
                                      share * double(foot.shares[k]));
    }
  }
  return out;
}

// Projects the scan's border points perpendicularly to the nearest border edges of the level.
void CurveFit::add_borders(const LevelFit& fit, std::vector<MoveEquations>& equations) const {
  const GridLevel& grid = fit.cells().grid();
  const ControlMesh& mesh = problem_.mesh;
  struct Side {
    Index from, to;
  };
  std::vector<Side> sides;
  for (std::size_t e = 0; e < mesh.edges.size(); ++e)
    if (mesh.feature_edge[e] && mesh.edges[e].boundary())
      for (int k = 0; k < grid.n(); ++k)
        sides.push_back({grid.edge_point(Index(e), k), grid.edge_point(Index(e), k + 1)});
  const double* const x = fit.surface().data();
  // A border of the scan that is farther away is the rim of a hole.
  const double reach = problem_.units.edge_in_space / 2;
  for (std::size_t b = 0; b < scan_.border.size(); ++b) {
    stop_if_cancelled();
    double least = reach * reach;
    const Side* nearest = nullptr;
    double share = 0;
    for (const Side& side : sides) {
      const Vec3 from = point_at(x, side.from), along = point_at(x, side.to) - from;
      const double t =
          std::clamp((scan_.border[b] - from).dot(along) / along.squaredNorm(), 0.0, 1.0);
      const double square = (scan_.border[b] - from - t * along).squaredNorm();
      if (!(square < least)) continue;
      least = square;
      nearest = &side;
      share = t;
    }
    if (!nearest) continue;
    const Vec3 from = point_at(x, nearest->from), along = point_at(x, nearest->to) - from;
    const Vec3 tangent = along.normalized();
    const Eigen::Matrix3d across = Eigen::Matrix3d::Identity() - tangent * tangent.transpose();
    const Vec3 offset = scan_.border[b] - from - share * along;
    equations[std::size_t(nearest->from)].add(across, offset, 1 - share);
    equations[std::size_t(nearest->to)].add(across, offset, share);
  }
}

std::vector<CurveFit::MoveEquations> CurveFit::control_equations(
    const std::vector<MoveEquations>& points, const GridLevel& grid) const {
  const ControlMesh& mesh = problem_.mesh;
  std::vector<MoveEquations> sum(std::size_t(mesh.input_vertices));
  for (std::size_t e = 0; e < mesh.edges.size(); ++e) {
    if (!mesh.feature_edge[e]) continue;
    const auto& ends = mesh.edges[e].vertex;
    for_curve_points(grid, Index(e), [&](Index p, double t) {
      for (const int end : {0, 1}) {
        if (!moves_[std::size_t(ends[std::size_t(end)])]) continue;
        const MoveEquations& equation = points[std::size_t(p)];
        const double share = end == 0 ? 1 - t : t;
        MoveEquations& own = sum[std::size_t(mesh.original_vertex(ends[std::size_t(end)]))];
        own.square += share * equation.square;
        own.rest += share * equation.rest;
      }
    });
  }
  return sum;
}

// In the frame's unit, one a control vertex; directions without enough points stay.
std::vector<Vec3> CurveFit::moves(const std::vector<MoveEquations>& equations, double weight,
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
  const double stiffness = 1 / (weight * stiffness_of_wave);
  for (const Bend& bend : bends_) {
    const double points = equations[std::size_t(bend.at[1])].square.trace();
    Vec3 bent = Vec3::Zero();
    for (std::size_t k = 0; k < 3; ++k) bent += bend.row[k] * place[std::size_t(bend.at[k])];
    for (std::size_t k = 0; k < 3; ++k) {
      const int row = unknown[std::size_t(bend.at[k])];
      if (row < 0) continue;
      const double factor = points * stiffness * bend.row[k];
      for (int i = 0; i < 3; ++i) rest[3 * row + i] -= factor * bent[i];
      for (std::size_t m = 0; m < 3; ++m)
        if (const int column = unknown[std::size_t(bend.at[m])]; column >= 0)
          for (int i = 0; i < 3; ++i)
            terms.emplace_back(3 * row + i, 3 * column + i, factor * bend.row[m]);
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
  std::vector<MoveEquations> points = equations(fit);
  add_borders(fit, points);
  const double scale = problem_.frame.scale;
  std::vector<Vec3> place(std::size_t(problem_.mesh.input_vertices));
  for (std::size_t v = 0; v < place.size(); ++v) place[v] = control.world[v] / scale;
  const std::vector<Vec3> move =
      moves(control_equations(points, fit.cells().grid()), weight, place);
  std::vector<double> world(3 * place.size());
  for (std::size_t v = 0; v < place.size(); ++v)
    put_point(control.world[v] + scale * move[v], world.data() + 3 * v);
  control = problem_.control_positions(world);
}

}  // namespace fairing
