// SPDX-License-Identifier: GPL-3.0-or-later
#include "thin_plate/levels.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/roundoff.h"
#include "constraints/pads.h"
#include "grid/injection.h"
#include "grid/linear.h"
#include "parallel/reductions.h"

namespace fairing {
namespace {

// A membrane's share of the diagonal falls to a quarter from level to level, so it is negligible
// with edges in 16 pieces and large with four.
constexpr std::size_t settled_under_tension = 2;  // in levels

// The levels of the hierarchy start at `base`, the coarsest level with a solve.
HierarchyOptions hierarchy_options(const Unknowns& unknowns, const ThinPlateOptions& options,
                                   int base, bool tense, bool has_flats) {
  HierarchyOptions out;
  out.smoother_degree = options.solve.smoother_degree;
  out.always_factor = unknowns.any_vertex;
  if (has_flats) out.hard_levels = HardLevels::expected;
  out.settled -= std::size_t(base);
  if (tense) out.settled += settled_under_tension;
  return out;
}

// Values of the finest level at the points of another level.
template <int C, class T>
Array<T> on_level(const std::vector<std::unique_ptr<GridLevel>>& grids, int level,
                  const Array<T>& finest, Workers& workers) {
  Array<T> out = finest;
  for (std::size_t l = grids.size() - 1; l > std::size_t(level); --l) {
    Array<T> coarser(C * grids[l - 1]->size());
    inject<C>(*grids[l - 1], *grids[l], workers, out.data(), coarser.data());
    out = std::move(coarser);
  }
  return out;
}

// The unknowns, and the control vertices that may be on pads.
Unknowns with_pads(const ControlMesh& mesh, const Unknowns& unknowns, double pad_size) {
  Unknowns out = unknowns;
  for (std::size_t v = 0; v < out.vertex.size() && pad_size > 0; ++v)
    if (may_have_pad(mesh, Index(v))) out.vertex[v] = out.any_vertex = true;
  return out;
}

}  // namespace

ThinPlateLevels::ThinPlateLevels(const ControlMesh& mesh, const Stencils& stencils,
                                 Unknowns unknowns, const VertexWeights& weights,
                                 const ThinPlateOptions& options, Workers& workers,
                                 const Monitor& monitor)
    : shared_(mesh, stencils, std::move(unknowns), workers),
      base_(shared_.unknowns.any_vertex ? 0 : std::min(1, options.levels)),
      carried_(with_pads(mesh, shared_.unknowns, options.pad_size)) {
  for (int l = 0; l <= options.levels; ++l) grids_.push_back(std::make_unique<GridLevel>(mesh, l));
  std::vector<HierarchyLevel> all;
  for (int l = base_; l <= top(); ++l) {
    monitor.check_cancelled();
    operators_.push_back(std::make_unique<ThinPlateLevel>(shared_, grid(l), weights));
    if (l > 0)
      transfers_.push_back(std::make_unique<QuadraticTransfer<3>>(
          grid(l - 1), grid(l), stencils, shared_.unknowns, workers, shared_.float_slots));
    all.push_back(
        {*operators_.back(), l > base_ ? transfers_.back().get() : nullptr, unknowns_of(l)});
  }
  hierarchy_ = std::make_unique<Hierarchy>(
      workers,
      hierarchy_options(shared_.unknowns, options, base_, !stencils.tension.empty(),
                        !mesh.flat.face.empty()),
      all);
}

void ThinPlateLevels::set_weights(const VertexWeights& weights, int level) {
  for (int l = base_; l <= level; ++l) operators_[index(l)]->set_weights(weights);
}

void ThinPlateLevels::put_fixed(int level, const PlateData& data, double* x) const {
  const GridLevel& lat = grid(level);
  for (std::size_t v = 0; v < data.targets.size(); ++v)
    if (!shared_.unknowns.vertex[v])
      for (int a = 0; a < 3; ++a) x[3 * v + std::size_t(a)] = data.targets[v][a];
  const int stride = grid(top()).n() / lat.n();
  for (std::size_t e = 0; e < shared_.mesh.edges.size(); ++e) {
    if (data.curves.run[e] < 0) continue;
    const auto points = data.curves.of(Index(e));
    for (int k = 1; k < lat.n(); ++k)
      for (int a = 0; a < 3; ++a)
        x[3 * std::size_t(lat.edge_point(Index(e), k)) + std::size_t(a)] =
            points[k * stride - 1][a];
  }
  refine_outside(lat, data.targets, data.curves.run, x);
}

void ThinPlateLevels::residual(int level, std::span<const Vec3> targets,
                               const Array<double>& reference, const double* x, double* r) {
  op(level).apply(x, r);
  for_each_index(workers(), 3 * grid(level).size(), [&](std::size_t i) { r[i] = -r[i]; });
  const VertexWeights& w = weights(level);
  for (std::size_t v = 0; v < w.size(); ++v)
    if (shared_.unknowns.vertex[v])
      for (int a = 0; a < 3; ++a) r[3 * v + std::size_t(a)] += w[v] * targets[v][a];
  add_penalty(level, reference, r);
}

void ThinPlateLevels::restrict_to_vertices(int level, const double* r, std::span<Vec3> sums) {
  fairing::restrict_to_vertices<3>(
      transfers_, level, carried_, workers(), {r, 3 * grid(level).size()},
      [&](int l) { return hierarchy_->room(index(l)); }, sums);
}

void ThinPlateLevels::measure(int level, const double* x,
                              const ThinPlateOptions::Penalty& penalty) {
  const Array<float> own = this->penalty(level, *penalty.of_points);
  operators_[index(level)]->measure({x, own.data(), penalty.exponent});
}

Array<float> ThinPlateLevels::penalty(int level, const Array<float>& finest) {
  return on_level<1>(grids_, level, finest, workers());
}

Array<double> ThinPlateLevels::reference(int level, const PlateData& data) {
  return data.reference ? on_level<3>(grids_, level, *data.reference, workers()) : Array<double>();
}

double ThinPlateLevels::bending(int level, const double* x) {
  return level < base_ ? thin_plate_energy(grid(level), shared_.stencils, workers(), x)
                       : operators_[index(level)]->bending(x);
}

double ThinPlateLevels::energy(int level, const double* x) {
  return bending(level, x) + membrane_energy(grid(level), shared_.stencils, workers(), x);
}

void ThinPlateLevels::start(int level, const PlateData& data, const Array<double>& below,
                            Array<double>& x) {
  if (level == base_)
    refine_linearly(grid(level), data.targets, workers(), x.data());
  else
    prolong(grid(level - 1), grid(level), shared_.stencils, nullptr, workers(),
            shared_.double_slots, below.data(), x.data());
  put_fixed(level, data, x.data());
}

ThinPlateLevels::Scales ThinPlateLevels::scales(int level, const PlateData& data,
                                                const Array<double>& reference, double* x,
                                                double* r) {
  const std::size_t size = 3 * grid(level).size();
  refine_linearly(grid(level), data.targets, workers(), x);
  put_fixed(level, data, x);
  residual(level, data.targets, reference, x, r);
  const Array<float>& inverse = op(level).inverse_diagonal();
  const double terms = std::sqrt(sum(workers(), size, [&](std::size_t i) {
    const double t = x[i] / double(inverse[i / 3]);
    return t * t;
  }));
  // If the polyhedron's residual is rounding, it is no scale: the polyhedron is the solution.
  return {std::max(norm(workers(), size, r), single_roundoff * terms), roundoff_of_terms * terms};
}

}  // namespace fairing
