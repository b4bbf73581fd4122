// SPDX-License-Identifier: GPL-3.0-or-later
#include "thin_plate/solver.h"

#include <cmath>
#include <tuple>
#include <utility>

#include "grid/linear.h"
#include "hold/hold_in_space.h"
#include "parallel/reductions.h"
#include "thin_plate/membrane.h"

namespace fairing {
namespace {

// Coarse levels are only starts for finer ones: solving them further than their own error is waste.
constexpr double coarse_tolerance = 1e-4;
// The differences that other control positions make are starts as well, and small beside the
// surface.
constexpr double difference_tolerance = 1e-2;
// Of the mesh's size: a difference that the finest level takes in its stride.
constexpr double negligible = 1e-6;

// Of the norm of a residual's terms: what is left of it below is rounding, some 20 units in the
// last place. And where the control polyhedron's own residual is less than so many times that, it
// measures nothing: the polyhedron is the solution already.
constexpr double rounding = 2e-15, least_over_noise = 1e8;

// Edges in eight pieces below: from such levels on the largest eigenvalue hardly changes. (With four
// it does: what the smoother then amplified took 14 iterations on a rough sphere in place of five.)
// The hierarchy counts from the level base_.
constexpr std::size_t settled_from_level_0 = 4, settled_from_level_1 = 3;
// A membrane's share of the diagonal falls to a quarter from level to level: what is hardly anything
// on edges in 16 pieces was much of it on those in four.
constexpr std::size_t settled_under_tension = 2;  // levels later

// Shares of the run in the progress: before the finest level's iterations and after them; the
// latter where Gauss-Newton steps follow, which take longer; and what a level takes of the next
// finer one's.
constexpr double solve_begin = 0.25, solve_end = 0.8, begin_of_steps = 0.3;
constexpr double share_of_coarser = 0.25;

HierarchyOptions hierarchy_options(const Unknowns& unknowns, const ThinPlateOptions& options,
                                   bool tense) {
  HierarchyOptions out;
  out.smoother_degree = options.smoother_degree;
  out.always_factor = unknowns.any_vertex;
  out.may_block = true;
  out.settled = unknowns.any_vertex ? settled_from_level_0 : settled_from_level_1;
  if (tense) out.settled += settled_under_tension;
  return out;
}

}  // namespace

ThinPlateSolver::ThinPlateSolver(const ControlMesh& mesh, const FeatureCurves& curves,
                                 const ChartMaker& charts, const Stencils& stencils,
                                 Unknowns unknowns, VertexWeights weights,
                                 const ThinPlateOptions& options, Workers& workers,
                                 Monitor& monitor)
    : mesh_(mesh),
      curves_(&curves),
      options_(options),
      workers_(workers),
      monitor_(monitor),
      base_(unknowns.any_vertex ? 0 : std::min(1, options.levels)),
      hierarchy_(workers, hierarchy_options(unknowns, options, stencils.membrane.any())),
      shared_(mesh, stencils, std::move(unknowns), std::move(weights), workers) {
  for (int l = 0; l <= options.levels; ++l) grids_.push_back(std::make_unique<GridLevel>(mesh, l));
  for (int l = base_; l <= top(); ++l) {
    monitor.check_cancelled();
    operators_.push_back(std::make_unique<ThinPlateLevel>(shared_, grid(l)));
    if (l > base_) {
      transfer_matrices_.push_back(
          AssembledTransfer::make(grid(l - 1), grid(l), stencils, shared_.unknowns, workers));
      transfers_.push_back(std::make_unique<QuadraticTransfer<3>>(
          grid(l - 1), grid(l), stencils, shared_.unknowns, transfer_matrices_.back().get(),
          workers, shared_.float_slots));
    }
    hierarchy_.add(*operators_.back(), l > base_ ? transfers_.back().get() : nullptr,
                   count_unknowns(grid(l), shared_.unknowns));
  }
  hierarchy_.complete();
  if (options.pad_size > 0)
    pads_ = std::make_unique<Pads>(mesh, charts, shared_.unknowns, options.pad_size, workers,
                                   shared_.weights);
  if (pads_ && !pads_->any()) pads_.reset();
  if (!options.normals.empty() && top() > 0) {
    couples_ = std::make_unique<Couples>(mesh, charts, options.normals, workers);
    held_.moments.assign(couples_->size(), Vec2::Zero());
  }
  if (!shared_.unknowns.any_vertex) return;
  const Array<float> diagonal =
      thin_plate_diagonal(grid(0), stencils, shared_.unknowns, {}, workers, shared_.double_slots);
  stiffness_.assign(diagonal.begin(), diagonal.begin() + mesh.vertex_count());
}

ThinPlateSolver::~ThinPlateSolver() = default;

void ThinPlateSolver::set_weights(const VertexWeights& weights, int level) {
  shared_.weights = weights;
  weighted_up_to_ = level;
  for (int l = base_; l <= level; ++l) operators_[std::size_t(l - base_)]->update();
  hierarchy_.refresh(std::size_t(level - base_), false);
}

void ThinPlateSolver::take_shape(const FeatureCurves& curves, const VertexWeights& weights,
                                 bool adapts) {
  curves_ = &curves;
  hierarchy_.set_adapting(adapts);
  if (shared_.weights != weights) set_weights(weights, top());
}

void ThinPlateSolver::set_fixed(int level, std::span<const Vec3> targets,
                                const FeatureCurves& curves, double* x) const {
  const GridLevel& lat = grid(level);
  for (std::size_t v = 0; v < targets.size(); ++v)
    if (!shared_.unknowns.vertex[v])
      for (int a = 0; a < 3; ++a) x[3 * v + std::size_t(a)] = targets[v][a];
  const int stride = grid(top()).n() / lat.n();
  for (std::size_t e = 0; e < mesh_.edges.size(); ++e) {
    if (curves.run[e] < 0) continue;
    const auto points = curves.of(Index(e));
    for (int k = 1; k < lat.n(); ++k)
      for (int a = 0; a < 3; ++a)
        x[3 * std::size_t(lat.edge_point(Index(e), k)) + std::size_t(a)] =
            points[std::size_t(k * stride - 1)][a];
  }
  refine_outside_linearly(lat, targets, x);
}

void ThinPlateSolver::residual(int level, std::span<const Vec3> targets, const double* x,
                               double* r) {
  operators_[std::size_t(level - base_)]->apply(x, r);
  for_each_index(workers_, 3 * grid(level).size(), [&](std::size_t i) { r[i] = -r[i]; });
  const VertexWeights& w = shared_.weights;
  for (std::size_t v = 0; v < w.size(); ++v)
    if (shared_.unknowns.vertex[v])
      for (int a = 0; a < 3; ++a) r[3 * v + std::size_t(a)] += w[v] * targets[v][a];
}

double ThinPlateSolver::bending(int level, const double* x) {
  return thin_plate_energy(grid(level), shared_.stencils, workers_, x);
}

double ThinPlateSolver::energy(int level, const double* x) {
  return bending(level, x) + membrane_energy(grid(level), shared_.stencils, workers_, x);
}

ThinPlateSolver::Scales ThinPlateSolver::scales(int level, std::span<const Vec3> targets,
                                                double* x) {
  const std::size_t size = 3 * grid(level).size();
  Array<double>& r = hierarchy_.state().residual;
  refine_linearly(grid(level), targets, workers_, x);
  set_fixed(level, targets, x);
  residual(level, targets, x, r.data());
  const Array<float>& inverse = operators_[std::size_t(level - base_)]->inverse_diagonal();
  const double terms = std::sqrt(sum(workers_, size, [&](std::size_t i) {
    const double t = x[i] / double(inverse[i / 3]);
    return t * t;
  }));
  const double noise = rounding * terms;
  return {std::max(norm(workers_, size, r.data()), least_over_noise * noise), noise};
}

PcgLimits ThinPlateSolver::limits_of(double tolerance, const Scales& scale,
                                     double energy_scale) const {
  PcgLimits limits;
  limits.tolerance = tolerance;
  limits.residual_scale = scale.residual;
  limits.noise = scale.noise;
  limits.energy_scale = std::sqrt(energy_scale);
  limits.max_iterations = options_.max_iterations;
  return limits;
}

LevelReport ThinPlateSolver::solve_level(int level, std::span<const Vec3> targets,
                                         const PcgLimits& limits, HoldInSpace* constraint,
                                         HeldState& held, double* x) {
  if (pads_ || constraint || has_couples(level))
    return solve_in_rounds(level, targets, limits, constraint, held, x);
  residual(level, targets, x, hierarchy_.state().residual.data());
  LevelReport report;
  report.level = level;
  report.points = grid(level).size();
  report.unknowns = count_unknowns(grid(level), shared_.unknowns);
  static_cast<LevelSolve&>(report) = hierarchy_.solve(
      std::size_t(level - base_), limits,
      [&](const double* y, double* r) { residual(level, targets, y, r); }, x,
      [&](const PcgResult& so_far) { report_progress(level, so_far, limits.tolerance); });
  return report;
}

void ThinPlateSolver::report_progress(int level, const PcgResult& so_far, double tolerance) {
  const double start = so_far.history.front();
  const double done = start > tolerance && so_far.residual > 0
                          ? std::log(start / so_far.residual) / std::log(start / tolerance)
                          : 1.0;
  report_done(level, done);
}

// On the finest level the iterations are most of the run.
void ThinPlateSolver::report_done(int level, double done) {
  if (level != top()) return;
  const double end = options_.starts_steps ? begin_of_steps : solve_end;
  monitor_.report(Phase::solve, solve_begin + (end - solve_begin) * std::clamp(done, 0.0, 1.0));
}

const Array<double>& ThinPlateSolver::surface_below(int level, Array<double>& x) {
  x.resize(3 * grid(top()).size());
  below_.resize(level > base_ ? 3 * grid(level - 1).size() : 0);
  for_each_index(workers_, below_.size(), [&](std::size_t i) { below_[i] = x[i]; });
  return below_;
}

void ThinPlateSolver::start_level(int level, std::span<const Vec3> targets,
                                  const Array<double>& below, Array<double>& x) {
  if (level == base_)
    refine_linearly(grid(level), targets, workers_, x.data());
  else
    prolong(grid(level - 1), grid(level), shared_.stencils, nullptr, workers_, shared_.double_slots,
            below.data(), x.data());
  set_fixed(level, targets, x.data());
}

void ThinPlateSolver::solve_nested(std::span<const Vec3> targets, Array<double>& x,
                                   std::vector<LevelReport>& reports,
                                   const std::function<void(const double*)>& on_prediction,
                                   const std::function<void(int, Array<double>&)>& on_level,
                                   HoldInSpace* constraint) {
  if (constraint) constraint->set_stiffness(stiffness_);
  double energy_below = 0;  // energies hardly change from level to level
  for (int l = base_; l <= top(); ++l) {
    monitor_.report(Phase::solve, solve_begin * std::pow(share_of_coarser, top() - l));
    if (weighted_up_to_ >= 0 && l > weighted_up_to_) set_weights(VertexWeights(shared_.weights), l);
    const Array<double>& below = surface_below(l, x);
    const Scales scale = scales(l, targets, x.data());
    const Loads loads = held_.loads, coarse_forces = held_.coarse_forces;
    start_held(l, !constraint, held_);
    start_level(l, targets, below, x);
    if (l == top() && on_prediction) on_prediction(x.data());
    const auto tolerance = [&](int level) {
      return level >= top() ? options_.relative_residual
                            : std::max(coarse_tolerance, options_.relative_residual);
    };
    if (l == base_) energy_below = energy(l, x.data());
    const PcgLimits limits = limits_of(tolerance(l), scale, energy_below);
    if (l == top()) finest_limits_ = limits;
    // Tolerances begin from what holds the interpolating surface.
    if (constraint && pads_ && l == std::clamp(level_of_first_loads, base_, top()))
      solve_level(l, targets, limits, nullptr, held_, x.data());
    reports.push_back(solve_level(l, targets, limits, constraint, held_, x.data()));
    if (leave_thrown_pads(l, targets, x.data())) {
      std::tie(held_.loads, held_.coarse_forces) = std::tie(loads, coarse_forces);
      start_held(l, !constraint, held_);
      start_level(l, targets, below, x);
      const LevelReport thrown = std::exchange(
          reports.back(), solve_level(l, targets, limits, constraint, held_, x.data()));
      reports.back().iterations += thrown.iterations;
      reports.back().pad_corrections += thrown.pad_corrections;
    }
    if (l < top()) energy_below = energy(l, x.data());
    if (l < top())
      hierarchy_.choose_degree(
          pads_ || constraint || has_couples(l) ? equivalent_solve_ : reports.back(), tolerance(l),
          tolerance(l + 1));
    on_level(l, x);
  }
}

void ThinPlateSolver::solve_moved(std::span<const Vec3> before, std::span<const Vec3> targets,
                                  double tolerance, Array<double>& x,
                                  std::vector<LevelReport>& reports,
                                  const std::function<void(const double*)>& on_prediction) {
  double farthest = 0;
  for (std::size_t v = 0; v < targets.size(); ++v)
    farthest = std::max(farthest, (targets[v] - before[v]).lpNorm<Eigen::Infinity>());
  if (farthest > negligible && base_ < top()) add_difference(before, targets, x, reports);
  set_fixed(top(), targets, x.data());
  if (on_prediction) on_prediction(x.data());
  PcgLimits limits = finest_limits_;
  limits.tolerance = tolerance;
  reports.push_back(solve_level(top(), targets, limits, nullptr, held_, x.data()));
}

FeatureCurves ThinPlateSolver::moves_of_curves(const Array<double>& x) const {
  FeatureCurves moves = *curves_;
  for (std::size_t e = 0; e < mesh_.edges.size(); ++e) {
    if (moves.run[e] < 0) continue;
    Vec3* const moved =
        moves.points.data() + std::size_t(moves.run[e]) * std::size_t(moves.points_per_edge);
    const double* const now = x.data() + 3 * std::size_t(grid(top()).edge_base(Index(e)));
    for (int k = 0; k < moves.points_per_edge; ++k)
      moved[k] -= Vec3(now[3 * k], now[3 * k + 1], now[3 * k + 2]);
  }
  return moves;
}

// The difference solves the same system, for the differences of what is fixed or weighted.
void ThinPlateSolver::add_difference(std::span<const Vec3> before, std::span<const Vec3> targets,
                                     Array<double>& x, std::vector<LevelReport>& reports) {
  std::vector<Vec3> moves(targets.size());
  for (std::size_t v = 0; v < targets.size(); ++v) moves[v] = targets[v] - before[v];
  const FeatureCurves curves = moves_of_curves(x);
  PcgLimits rough;
  rough.tolerance = difference_tolerance;
  rough.from_start = true;
  rough.noise = finest_limits_.noise;
  rough.max_iterations = options_.max_iterations;
  HeldState held{{}, Moments(held_.moments.size(), Vec2::Zero())};
  Array<double> difference;
  for (int l = base_; l <= top(); ++l) {
    start_held(l, true, held);
    start_level(l, moves, surface_below(l, difference), difference);
    set_fixed(l, moves, curves, difference.data());
    if (l < top())
      reports.push_back(solve_level(l, moves, rough, nullptr, held, difference.data()));
  }
  for_each_index(workers_, 3 * grid(top()).size(), [&](std::size_t i) { x[i] += difference[i]; });
  for (std::size_t v = 0; v < held_.loads.size(); ++v) held_.loads[v] += held.loads[v];
  for (std::size_t c = 0; c < held.moments.size(); ++c) held_.moments[c] += held.moments[c];
}

LevelReport ThinPlateSolver::solve_again(int level, std::span<const Vec3> targets, Array<double>& x,
                                         double tolerance) {
  Array<double> polyhedron(3 * grid(level).size());
  const Scales scale = scales(level, targets, polyhedron.data());
  set_fixed(level, targets, x.data());
  return solve_level(level, targets, limits_of(tolerance, scale, energy(level, x.data())), nullptr,
                     held_, x.data());
}

}  // namespace fairing
