// SPDX-License-Identifier: GPL-3.0-or-later
#include "thin_plate/solver.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/roundoff.h"
#include "parallel/reductions.h"
#include "thin_plate/run.h"

namespace fairing {
namespace {

// Share of the next finer level's time, in proportion to the number of points.
constexpr double share_of_coarser = 0.25;

}  // namespace

ThinPlateSolver::ThinPlateSolver(const ControlMesh& mesh, const ChartMaker& charts,
                                 const Stencils& stencils, Unknowns unknowns,
                                 const VertexWeights& weights, const ThinPlateOptions& options,
                                 Workers& workers, Monitor& monitor)
    : options_(options),
      monitor_(monitor),
      levels_(mesh, stencils, std::move(unknowns), weights, options, workers, monitor),
      supports_(charts, options, levels_) {}

void ThinPlateSolver::Run::begin(int level, const PlateSurface& below) {
  x.resize(size(level));
  r.resize(size(level));
  reference = levels().reference(level, data);
  const ThinPlateOptions::Penalty& penalty = solver.options_.penalty;
  if (!penalty.of_points || levels().is_measured(level)) return;
  if (level > base()) levels().start(level, data, below.x, x);
  levels().measure(level, level > base() ? x.data() : reference.data(), penalty);
}

void ThinPlateSolver::Run::start(int level, bool foretells, const PlateSurface& below,
                                 Loads& forces) {
  state = level > base() ? below.state : solver.supports_.unloaded();
  forces = below.forces;
  solver.supports_.start(level, foretells, state, forces);
  levels().start(level, data, below.x, x);
}

// `room`: a surface's memory, for the control polyhedron.
PcgLimits ThinPlateSolver::Run::limits(int level, double tolerance, double energy, double* room) {
  const ThinPlateLevels::Scales scale = levels().scales(level, data, reference, room, r.data());
  PcgLimits limits;
  limits.tolerance = tolerance;
  limits.residual_scale = scale.residual;
  limits.noise = scale.noise;
  limits.energy_scale = std::sqrt(energy);
  limits.max_iterations = solver.options_.solve.max_iterations;
  return limits;
}

LevelReport ThinPlateSolver::Run::report_of(int level) const {
  LevelReport report;
  report.level = level;
  report.points = levels().grid(level).size();
  report.unknowns = levels().unknowns_of(level);
  return report;
}

// On the finest level the iterations take most of the run, unless Gauss-Newton steps follow; their
// progress starts where that of this level starts. Otherwise measuring starts at its end.
void ThinPlateSolver::Run::report_done(int level, double done) const {
  if (level != top() || solver.options_.starts_steps) return;
  const double share = share_of_coarser + 0.5 * std::clamp(done, 0.0, 1.0);
  solver.monitor_.report(Phase::solve, share);
}

BallConstraints ThinPlateSolver::begin(ControlConstraints held) {
  BallConstraints out(std::move(held), supports_.stiffness());
  if (levels_.weights(levels_.top()) != out.weights())
    levels_.set_weights(out.weights(), levels_.top());
  return out;
}

double ThinPlateSolver::tolerance_of(int level) const {
  const double wanted = options_.solve.relative_residual;
  // Coarse levels only start finer ones: solving them below their discretization error is wasted.
  return level >= levels_.top() ? wanted : std::max(SolveOptions().relative_residual, wanted);
}

PlateSurface ThinPlateSolver::solve_level(int level, const PlateData& data,
                                          BallConstraints& constraints, const PlateSurface& below,
                                          std::vector<LevelReport>& reports,
                                          const OnPrediction& on_prediction) {
  const bool is_base = level == levels_.base(), is_top = level == levels_.top();
  monitor_.report(Phase::solve, std::pow(share_of_coarser, levels_.top() - level + 1));
  BallConstraints* const active = constraints.active() ? &constraints : nullptr;
  if (active && !is_base) {
    active->renew_springs(below.x.data());
    levels_.set_weights(active->weights(), level);
  }
  PlateSurface out;
  Run run{*this, data, out.state, out.x};
  run.begin(level, below);
  PcgLimits limits = run.limits(level, tolerance_of(level), below.energy, out.x.data());
  run.start(level, !active, below, out.forces);
  if (is_top && on_prediction) on_prediction(out.x.data());
  // Energies hardly change between levels.
  if (is_base) limits.energy_scale = std::sqrt(levels_.energy(level, out.x.data()));
  if (is_top) out.state.limits = limits;
  const Run::Solved solved = run.solve(level, limits, active);
  reports.push_back(solved.report);
  if (!is_top) {
    out.energy = levels_.energy(level, out.x.data());
    levels_.hierarchy().choose_degree(solved.equivalent, tolerance_of(level),
                                      tolerance_of(level + 1), solve_gain);
  }
  return out;
}

void ThinPlateSolver::solve_moved(const PlateData& before, const PlateData& data, double tolerance,
                                  PlateState& state, Array<double>& x,
                                  std::vector<LevelReport>& reports,
                                  const OnPrediction& on_prediction) {
  double farthest = 0;
  for (std::size_t v = 0; v < data.targets.size(); ++v)
    farthest = std::max(farthest, (data.targets[v] - before.targets[v]).lpNorm<Eigen::Infinity>());
  // The finest level removes errors of the size of single precision at no cost.
  if (farthest > single_roundoff && levels_.base() < levels_.top())
    add_difference(before, data, state, x, reports);
  levels_.put_fixed(levels_.top(), data, x.data());
  if (on_prediction) on_prediction(x.data());
  PcgLimits limits = state.limits;
  limits.tolerance = tolerance;
  Run run{*this, data, state, x};
  run.r.resize(x.size());
  run.reference = levels_.reference(levels_.top(), data);
  reports.push_back(run.solve(levels_.top(), limits, nullptr).report);
}

namespace {

// The moves of the curves' points from their places in x to the new ones.
FeatureCurves moves_of_curves(const FeatureCurves& curves, const GridLevel& grid,
                              const Array<double>& x) {
  FeatureCurves moves = curves;
  for (std::size_t e = 0; e < grid.mesh().edges.size(); ++e) {
    if (moves.run[e] < 0) continue;
    Vec3* const moved =
        moves.points.data() + std::size_t(moves.run[e]) * std::size_t(moves.points_per_edge);
    const double* const now = x.data() + 3 * std::size_t(grid.edge_base(Index(e)));
    for (int k = 0; k < moves.points_per_edge; ++k)
      moved[k] -= Vec3(now[3 * k], now[3 * k + 1], now[3 * k + 2]);
  }
  return moves;
}

}  // namespace

// The difference solves the same system, for the differences of fixed and weighted data.
void ThinPlateSolver::add_difference(const PlateData& before, const PlateData& data,
                                     PlateState& state, Array<double>& x,
                                     std::vector<LevelReport>& reports) {
  std::vector<Vec3> moves(data.targets.size());
  for (std::size_t v = 0; v < moves.size(); ++v) moves[v] = data.targets[v] - before.targets[v];
  const FeatureCurves curves = moves_of_curves(data.curves, levels_.grid(levels_.top()), x);
  Array<double> reference;
  if (data.reference) {
    reference.resize(x.size());
    for_each_index(levels_.workers(), x.size(), [&](std::size_t i) {
      reference[i] = (*data.reference)[i] - (*before.reference)[i];
    });
  }
  const PlateData moving{moves, curves, data.reference ? &reference : nullptr};
  PcgLimits rough;
  rough.tolerance = difference_tolerance;
  rough.from_start = true;
  rough.noise = state.limits.noise;
  rough.max_iterations = options_.solve.max_iterations;
  PlateSurface change;
  for (int l = levels_.base(); l <= levels_.top(); ++l) {
    const PlateSurface below = std::exchange(change, {});
    Run run{*this, moving, change.state, change.x};
    run.begin(l, below);
    run.start(l, true, below, change.forces);
    if (l < run.top()) reports.push_back(run.solve(l, rough, nullptr).report);
  }
  for_each_index(levels_.workers(), x.size(), [&](std::size_t i) { x[i] += change.x[i]; });
  for (std::size_t v = 0; v < state.loads.size(); ++v) state.loads[v] += change.state.loads[v];
  for (std::size_t c = 0; c < state.moments.size(); ++c)
    state.moments[c] += change.state.moments[c];
}

LevelReport ThinPlateSolver::solve_again(const PlateData& data, double tolerance, PlateState& state,
                                         Array<double>& x, double rough_force) {
  const int top = levels_.top();
  Run run{*this, data, state, x};
  run.rough_force = rough_force;
  run.r.resize(x.size());
  run.reference = levels_.reference(top, data);
  PcgLimits limits;
  {
    Array<double> polyhedron(x.size());
    limits = run.limits(top, tolerance, 0, polyhedron.data());
  }
  levels_.put_fixed(top, data, x.data());
  limits.energy_scale = std::sqrt(levels_.energy(top, x.data()));
  return run.solve(top, limits, nullptr).report;
}

}  // namespace fairing
