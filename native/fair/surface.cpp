// SPDX-License-Identifier: GPL-3.0-or-later
#include "fair/surface.h"

#include <cmath>

#include "execution/vectors.h"
#include "lattice/linear.h"
#include "solver/spectrum.h"

namespace fairing {
namespace {

// Coarse levels are only starts for finer ones: solving them further than their own error is waste.
constexpr double coarse_tolerance = 1e-4;

constexpr int first_probe = 6, probe_interval = 10;  // iterations
// Share of the run before and after the finest level's iterations.
constexpr double solve_begin = 0.25, solve_end = 0.8;

constexpr double iterations_wanted = 14;
constexpr int most_degree = 96;
constexpr int refinement_steps = 3;

// Levels up to so many unknowns are factored sooner than smoothed; the cycle ends on the finest of them.
constexpr std::size_t tiny_level = 1200;

// The smoother's degree from which on factoring a level is cheaper than smoothing it.
int degree_of_hard(std::size_t unknowns) { return 8 + int(unknowns / 5000); }

std::size_t count_unknowns(const Lattice& lattice, const Unknowns& unknowns) {
  const ControlMesh& mesh = lattice.mesh();
  std::size_t count = 0;
  for (std::size_t f = 0; f < mesh.faces.size(); ++f)
    if (unknowns.has_face(f)) count += std::size_t(interior_size(mesh.faces[f].quad(), lattice.n()));
  for (const auto u : unknowns.vertex) count += u;
  for (const auto u : unknowns.edge) count += u ? std::size_t(lattice.n() - 1) : 0;
  return count;
}

}  // namespace

SurfaceSystem::SurfaceSystem(const ControlMesh& mesh, const FeatureCurves& curves, const Stencils& stencils,
                             Unknowns unknowns, VertexWeights weights, const FairOptions& options,
                             Workers& workers, Monitor& monitor)
    : mesh_(mesh),
      curves_(&curves),
      options_(options),
      workers_(workers),
      monitor_(monitor),
      shared_(mesh, stencils, std::move(unknowns), std::move(weights), workers) {
  for (int l = 0; l <= options.levels; ++l) lattices_.push_back(std::make_unique<Lattice>(mesh, l));
  base_ = shared_.unknowns.any_vertex ? 0 : std::min(1, top());
  for (int l = base_; l <= top(); ++l) {
    monitor.check_cancelled();
    operators_.push_back(std::make_unique<ThinPlateLevel>(shared_, lattice(l)));
    if (l > base_)
      transfers_.push_back(std::make_unique<ThinPlateTransfer>(shared_, lattice(l - 1), lattice(l)));
  }
  std::size_t end = 0;  // of the cycle
  const auto unknowns_of = [&](std::size_t index) {
    return count_unknowns(lattice(base_ + int(index)), shared_.unknowns);
  };
  while (base_ + int(end) < top() && unknowns_of(end + 1) <= tiny_level) ++end;
  coarse_ = std::make_unique<CoarseSolver>(*operators_[end], workers, unknowns_of(end),
                                           shared_.unknowns.any_vertex);
  for (Array<double>* a : {&pcg_.residual, &pcg_.direction, &pcg_.image})
    a->resize(3 * lattice(top()).size());
  cycle_ = std::make_unique<VCycle>(workers, monitor);
  cycle_->coarse = coarse_.get();
  cycle_->base = end;
  if (options.smoother_degree > 0) cycle_->degree = options.smoother_degree;
  for (int l = base_; l <= top(); ++l) {
    CycleLevel level;
    level.op = operators_[std::size_t(l - base_)].get();
    if (l > base_) level.transfer = transfers_[std::size_t(l - base_ - 1)].get();
    level.state.resize(3 * lattice(l).size());
    cycle_->levels.push_back(std::move(level));
  }
}

SurfaceSystem::~SurfaceSystem() = default;

void SurfaceSystem::set_weights(const VertexWeights& weights, int level) {
  shared_.weights = weights;
  weighted_up_to_ = level;
  for (int l = base_; l <= level; ++l) operators_[std::size_t(l - base_)]->update();
  if (coarse_->direct() && level >= base_ + int(cycle_->base)) coarse_->refactor();
}

void SurfaceSystem::take_shape(const FeatureCurves& curves, const VertexWeights& weights) {
  curves_ = &curves;
  adapts_ = false;
  if (shared_.weights != weights) set_weights(weights, top());
}

void SurfaceSystem::set_fixed(int level, std::span<const Vec3> targets, double* x) const {
  const Lattice& lat = lattice(level);
  for (std::size_t v = 0; v < targets.size(); ++v)
    if (!shared_.unknowns.vertex[v])
      for (int a = 0; a < 3; ++a) x[3 * v + std::size_t(a)] = targets[v][a];
  const int stride = lattice(top()).n() / lat.n();
  for (std::size_t e = 0; e < mesh_.edges.size(); ++e) {
    if (curves_->run[e] < 0) continue;
    const auto points = curves_->of(Index(e));
    for (int k = 1; k < lat.n(); ++k)
      for (int a = 0; a < 3; ++a)
        x[3 * std::size_t(lat.edge_point(Index(e), k)) + std::size_t(a)] =
            points[std::size_t(k * stride - 1)][a];
  }
  refine_outside_linearly(lat, targets, x);
}

void SurfaceSystem::residual(int level, std::span<const Vec3> targets, const double* x, double* r) {
  operators_[std::size_t(level - base_)]->apply(x, r);
  for_each_index(workers_, 3 * lattice(level).size(), [&](std::size_t i) { r[i] = -r[i]; });
  const VertexWeights& w = shared_.weights;
  for (std::size_t v = 0; v < w.size(); ++v)
    if (shared_.unknowns.vertex[v])
      for (int a = 0; a < 3; ++a) r[3 * v + std::size_t(a)] += w[v] * targets[v][a];
}

double SurfaceSystem::energy(int level, const double* x) {
  return thin_plate_energy(lattice(level), shared_.fine_rows, workers_, x);
}

SurfaceSystem::Scales SurfaceSystem::scales(int level, std::span<const Vec3> targets) {
  const std::size_t size = 3 * lattice(level).size();
  Array<double>&x = pcg_.direction, &r = pcg_.image;
  refine_linearly(lattice(level), targets, x.data());
  set_fixed(level, targets, x.data());
  residual(level, targets, x.data(), r.data());
  const Array<float>& inverse = operators_[std::size_t(level - base_)]->inverse_diagonal();
  const double terms = std::sqrt(sum(workers_, size, [&](std::size_t i) {
    const double t = x[i] / double(inverse[i / 3]);
    return t * t;
  }));
  // Where the polyhedron is the solution already, its residual is rounding and measures nothing.
  const double noise = 2e-15 * terms;
  return {std::max(norm(workers_, size, r.data()), 1e8 * noise), noise};
}

LevelReport SurfaceSystem::solve_level(int level, std::span<const Vec3> targets, double tolerance,
                                       const Scales& scale, double* x) {
  const auto index = std::size_t(level - base_);
  LevelReport report;
  report.level = level;
  report.points = lattice(level).size();
  report.unknowns = count_unknowns(lattice(level), shared_.unknowns);
  residual(level, targets, x, pcg_.residual.data());

  if (index < cycle_->base) {  // beyond the cycle's end; met on the way up only
    const CoarseSolver solver(*operators_[index], workers_, 0, true);
    solve_direct(solver, level, targets, tolerance, scale, x, report);
    return report;
  }
  if (index == cycle_->base && coarse_->direct()) {
    solve_direct(*coarse_, level, targets, tolerance, scale, x, report);
    if (report.converged) return report;
  }

  CycleLevel& cycle_level = cycle_->levels[index];
  if (cycle_level.largest_eigenvalue == 0) cycle_level.largest_eigenvalue = estimate_eigenvalue(index);
  PcgLimits limits;
  limits.tolerance = tolerance;
  limits.residual_scale = scale.residual;
  limits.noise = scale.noise;
  limits.energy_scale = std::sqrt(energy(level, x));
  limits.max_iterations = options_.max_iterations;
  const bool adapt = adapts_ && options_.smoother_degree == 0 && !report.direct;
  const bool may_factor = adapt && report.unknowns <= direct_limit_of_hard;
  const auto too_hard = [&] { return may_factor && cycle_->degree >= degree_of_hard(report.unknowns); };
  PcgResult result =
      conjugate_gradients(*cycle_, index, workers_, limits, pcg_, x, [&](const PcgResult& so_far) {
        report_progress(level, so_far, tolerance);
        if (adapt && so_far.iterations % probe_interval == first_probe) raise_degree(so_far, tolerance);
        return !too_hard();
      });
  report.iterations = result.iterations;
  report.residuals = result.history;
  if (!result.converged && too_hard()) {
    promote_to_coarsest(index);
    solve_direct(*coarse_, level, targets, tolerance, scale, x, report);
    if (report.converged) return report;
    result =
        conjugate_gradients(*cycle_, index, workers_, limits, pcg_, x, [](const PcgResult&) { return true; });
    report.iterations += result.iterations;
  }
  report.smoother_degree = cycle_->degree;
  report.residual = result.residual;
  report.energy_error = result.energy_error;
  report.largest_eigenvalue = cycle_level.largest_eigenvalue;
  report.converged = result.converged;
  return report;
}

void SurfaceSystem::solve_direct(const CoarseSolver& solver, int level, std::span<const Vec3> targets,
                                 double tolerance, const Scales& scale, double* x, LevelReport& report) {
  const std::size_t size = 3 * lattice(level).size();
  report.direct = true;
  report.smoother_degree = 0;
  for (int step = 0; step < refinement_steps && !report.converged; ++step) {
    solver.solve(pcg_.residual.data(), pcg_.direction.data());
    for_each_index(workers_, size, [&](std::size_t i) { x[i] += pcg_.direction[i]; });
    residual(level, targets, x, pcg_.residual.data());
    const double now = norm(workers_, size, pcg_.residual.data());
    report.residual = scale.residual > 0 ? now / scale.residual : 0;
    report.converged = report.residual <= tolerance || now <= scale.noise;
  }
}

// Stencils repeat from level to level, and from some fineness on so does the spectrum's upper end.
double SurfaceSystem::estimate_eigenvalue(std::size_t index) {
  const double below = index > 0 ? cycle_->levels[index - 1].largest_eigenvalue : 0;
  if (below > 0 && lattice(base_ + int(index) - 1).n() >= 8) return 1.03 * below;
  return largest_eigenvalue(*cycle_->levels[index].op, workers_, pcg_.residual.data());
}

// From here on this level is the coarsest, solved directly.
void SurfaceSystem::promote_to_coarsest(std::size_t index) {
  coarse_ = std::make_unique<CoarseSolver>(*operators_[index], workers_, 0, true);
  cycle_->coarse = coarse_.get();
  cycle_->base = index;
  cycle_->degree = std::min(cycle_->degree, 12);
}

// On the finest level the iterations are most of the run.
void SurfaceSystem::report_progress(int level, const PcgResult& so_far, double tolerance) {
  if (level != top()) return;
  const double start = so_far.history.front();
  const double done = start > tolerance && so_far.residual > 0
                          ? std::log(start / so_far.residual) / std::log(start / tolerance)
                          : 1.0;
  monitor_.report(Phase::solve, solve_begin + (solve_end - solve_begin) * std::clamp(done, 0.0, 1.0));
}

// Skew makes a mesh hard, on all levels alike. What the iterations so far have gained tells how hard; the smoother's
// degree follows, so that the rest takes few iterations. (Iterations times degree, the work, hardly changes.)
void SurfaceSystem::raise_degree(const PcgResult& result, double tolerance) {
  // The first iterations are the easy ones; the latest tell more.
  const int window = std::min(result.iterations, probe_interval);
  const double gained =
      std::log(result.history[result.history.size() - 1 - std::size_t(window)] / result.residual);
  const double missing = std::log(std::max(result.residual / tolerance, result.energy_error / tolerance));
  const double ahead = gained > 0 ? window * missing / gained : 10.0 * iterations_wanted;
  if (ahead <= iterations_wanted) return;
  cycle_->degree =
      std::min(most_degree, int(std::ceil(cycle_->degree * std::min(8.0, ahead / iterations_wanted))));
}

// The same from one level to the next, which is solved further.
void SurfaceSystem::choose_degree(const LevelReport& report, double tolerance, double next_tolerance) {
  if (!adapts_ || options_.smoother_degree > 0 || report.direct || report.iterations < 4) return;
  const double ahead = report.iterations * std::log(next_tolerance) / std::log(tolerance);
  const double wanted = report.smoother_degree * std::min(2.0, ahead / iterations_wanted);
  cycle_->degree = std::clamp(int(std::ceil(wanted)), cycle_->degree, most_degree);
}

void SurfaceSystem::start_level(int level, std::span<const Vec3> targets, Array<double>& x) {
  if (level == base_) {
    x.resize(3 * lattice(top()).size());
    refine_linearly(lattice(level), targets, x.data());
  } else {
    const Array<double> coarse(x.begin(), x.begin() + std::ptrdiff_t(3 * lattice(level - 1).size()));
    prolong(lattice(level - 1), lattice(level), shared_.stencils, nullptr, workers_, shared_.fine_exchange,
            coarse.data(), x.data());
  }
  set_fixed(level, targets, x.data());
}

void SurfaceSystem::solve_nested(std::span<const Vec3> targets, Array<double>& x,
                                 std::vector<LevelReport>& reports,
                                 const std::function<void(const double*)>& on_prediction,
                                 const std::function<void(int, Array<double>&)>& on_level) {
  for (int l = base_; l <= top(); ++l) {
    monitor_.report(Phase::solve, solve_begin * std::pow(0.25, top() - l));
    if (weighted_up_to_ >= 0 && l > weighted_up_to_) set_weights(VertexWeights(shared_.weights), l);
    // Scales first: they borrow the vectors of the iteration.
    const Scales scale = scales(l, targets);
    start_level(l, targets, x);
    if (l == top() && on_prediction) on_prediction(x.data());
    const auto tolerance = [&](int level) {
      return level >= top() ? options_.relative_residual
                            : std::max(coarse_tolerance, options_.relative_residual);
    };
    reports.push_back(solve_level(l, targets, tolerance(l), scale, x.data()));
    if (l < top()) choose_degree(reports.back(), tolerance(l), tolerance(l + 1));
    on_level(l, x);
  }
}

LevelReport SurfaceSystem::solve_again(int level, std::span<const Vec3> targets, Array<double>& x,
                                       double tolerance) {
  const Scales scale = scales(level, targets);
  set_fixed(level, targets, x.data());
  return solve_level(level, targets, tolerance, scale, x.data());
}

}  // namespace fairing
