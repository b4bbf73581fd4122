// SPDX-License-Identifier: GPL-3.0-or-later
#include "fit/curves.h"

#include <Eigen/Dense>
#include <limits>

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

void CurveFit::move(const LevelFit& fit, ControlPositions& control) const {
  const ControlMesh& mesh = problem_.mesh;
  const GridLevel& grid = fit.cells().grid();
  std::vector<MoveEquations> at = equations(fit);
  add_borders(fit, at);
  std::vector<MoveEquations> sum(std::size_t(mesh.input_vertices));
  for (std::size_t e = 0; e < mesh.edges.size(); ++e) {
    if (!mesh.feature_edge[e]) continue;
    const auto& ends = mesh.edges[e].vertex;
    for_curve_points(grid, Index(e), [&](Index p, double t) {
      for (const int end : {0, 1}) {
        if (!moves_[std::size_t(ends[std::size_t(end)])]) continue;
        const MoveEquations& equation = at[std::size_t(p)];
        const double share = end == 0 ? 1 - t : t;
        MoveEquations& own = sum[std::size_t(mesh.original_vertex(ends[std::size_t(end)]))];
        own.square += share * equation.square;
        own.rest += share * equation.rest;
      }
    });
  }
  std::vector<double> world(3 * std::size_t(mesh.input_vertices));
  for (std::size_t v = 0; v < sum.size(); ++v) {
    Vec3 place = control.world[v];
    // directions without enough points stay
    const double trace = sum[v].square.trace();
    if (trace > 0) {
      const Eigen::Matrix3d square = sum[v].square + trace / 64 * Eigen::Matrix3d::Identity();
      place += problem_.frame.scale * Vec3(square.ldlt().solve(sum[v].rest));
    }
    put_point(place, world.data() + 3 * v);
  }
  control = problem_.control_positions(world);
}

}  // namespace fairing
