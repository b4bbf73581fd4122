// SPDX-License-Identifier: GPL-3.0-or-later
#include "fair/curvature.h"

#include <cmath>

#include "execution/vectors.h"
#include "fair/surface.h"
#include "lattice/sample.h"
#include "transfer/point_normal.h"
#include "transfer/transfer.h"

namespace fairing {
namespace {

constexpr double inner_accuracy = 1e-2;  // of the linear solves: a step gains no more
// Plain steps have to come to this decrement within so many, or it is done again with damped ones. On coarse levels they
// end there, as damped ones do anywhere.
constexpr double plain_decrement = 1e-3, damped_decrement = 3e-2;
constexpr int long_patience = 14, short_patience = 6;
constexpr int polishing_patience = 3;

// Of the steps to the least variation.
constexpr double variation_decrement = 1e-3, late_variation_decrement = 3e-2;
constexpr int variation_patience = 10;  // steps, after which the second will do
constexpr double variation_late = 1e-3;
constexpr double first_share = 0.1, least_share = 1e-6;  // of the energies' ratio
constexpr double still = 1e-4;  // of the curvature: variation that is as good as none

constexpr int release_rounds = 2;
constexpr double release_pull = 0.1;    // of a weight that balances a control edge
constexpr double release_aim = 0.9999;  // of epsilon: rounding must not carry a vertex over it

constexpr double steps_begin = 0.3, steps_end = 0.85;  // of the run

constexpr double flat = 1e-16;  // an energy that is rounding

constexpr double real_gain = 1 - 1e-9;  // what rounding may not decide
constexpr double hopeful =
    1.5;  // a start's energy, to the level below's, that needs no other to compare with
constexpr double as_low = 1.01;  // as the energy by damped steps

// The energy of a right step may rise a little near the end, where the discrete energy's minimum lies beside the
// solution of the equation; nearer still it does not tell any more.
constexpr double slack = 0.1;  // times the decrement
constexpr double late = 1e-2;  // decrement
constexpr double least_length = 1.0 / 8;
constexpr int most_rejections = 4;
constexpr double accelerated = 0.1;  // decrement below which steps are accelerated
constexpr double first_ratio = 10;   // times the first ratio of decrements, which flatters
constexpr double regular = 0.5;      // ratio of decrements below which they tell what is left

class DisplacementTransfer final : public LevelTransfer {
 public:
  DisplacementTransfer(CurvatureShared& shared, const Stencils& stencils, const Lattice& coarse,
                       const Lattice& fine)
      : shared_(shared), stencils_(stencils), coarse_(coarse), fine_(fine) {}
  void prolong(const float* x, float* y) override {
    fairing::prolong(coarse_, fine_, stencils_, &shared_.unknowns, shared_.workers, shared_.fast_exchange, x,
                     y);
  }
  void restrict_to(const float* x, float* y) override {
    fairing::restrict_to(coarse_, fine_, stencils_, shared_.unknowns, shared_.workers, shared_.fast_exchange,
                         x, y);
  }

 private:
  CurvatureShared& shared_;
  const Stencils& stencils_;
  const Lattice &coarse_, &fine_;
};

HierarchyOptions hierarchy_options(const Unknowns& unknowns, const FairOptions& options) {
  HierarchyOptions out;
  out.smoother_degree = options.smoother_degree;
  out.always_factor = unknowns.any_vertex;
  return out;
}

}  // namespace

CurvatureSystem::CurvatureSystem(const ControlMesh& mesh, std::vector<const Lattice*> lattices, int base,
                                 const Stencils& stencils, const Unknowns& unknowns,
                                 const FairOptions& options, ControlHold hold, double epsilon,
                                 Workers& workers, Monitor& monitor)
    : mesh_(mesh),
      lattices_(std::move(lattices)),
      base_(base),
      stencils_(stencils),
      options_(options),
      workers_(workers),
      monitor_(monitor),
      hold_(std::move(hold)),
      epsilon_(epsilon),
      shared_{mesh, unknowns, CurvatureEnergy::total_curvature, workers},
      hierarchy_(workers, monitor, hierarchy_options(unknowns, options)) {
  for (int l = base; l < int(lattices_.size()); ++l) {
    operators_.push_back(std::make_unique<CurvatureLevel>(shared_, lattice(l)));
    if (l > base)
      transfers_.push_back(
          std::make_unique<DisplacementTransfer>(shared_, stencils, lattice(l - 1), lattice(l)));
    hierarchy_.add(*operators_.back(), l > base ? transfers_.back().get() : nullptr,
                   count_unknowns(lattice(l), unknowns));
  }
  hierarchy_.complete();
  shared_.weights = hold_.weights();
  if (hold_.any()) shared_.targets.assign(hold_.places().begin(), hold_.places().end());
}

CurvatureSystem::~CurvatureSystem() = default;

void CurvatureSystem::linearize_below(int level) {
  const Array<double>* from = &surface_;
  Array<double> coarse[2];
  for (int l = level - 1; l >= base_; --l) {
    monitor_.check_cancelled();
    Array<double>& to = coarse[l % 2];
    to.resize(3 * lattice(l).size());
    sample<3>(lattice(l), lattice(l + 1), workers_, from->data(), to.data());
    op(l).linearize(to.data());
    from = &to;
  }
}

void CurvatureSystem::damp(int level, const Array<float>& mu) {
  op(level).set_damping(mu);
  if (mu.empty()) return;
  Array<float> fine = mu, coarse;
  for (int l = level - 1; l >= base_; --l) {
    coarse.resize(lattice(l).size());
    sample<1>(lattice(l), lattice(l + 1), workers_, fine.data(), coarse.data());
    op(l).set_damping(coarse);
    fine.swap(coarse);
  }
}

// The thin plate's surface, or the one that the level below has found: as its change of the plate, or bulged along its
// normals.
void CurvatureSystem::choose_start(int level, const Array<double>& plate, CurvatureLevelReport& report) {
  const std::size_t size = 3 * lattice(level).size();
  const Array<double> below = std::move(surface_);
  const double energy_below = energy_;
  surface_.assign(plate.begin(), plate.begin() + std::ptrdiff_t(size));
  energy_ = op(level).linearize(surface_.data(), &there_);
  report.plate_energy = report.start_energy = op(level).bending();
  is_linearized_ = true;
  if (!below.empty()) {
    trial_.resize(size);
    const auto take_if_lower = [&] {
      const double energy = op(level).linearize(trial_.data(), &there_), bending = op(level).bending();
      is_linearized_ = bending < real_gain * report.start_energy;
      if (!is_linearized_) return;
      report.start_energy = bending;
      energy_ = energy;
      std::swap(surface_, trial_);
    };
    Array<double> change(below.size());
    for_each_index(workers_, below.size(), [&](std::size_t i) { change[i] = below[i] - plate_below_[i]; });
    prolong(lattice(level - 1), lattice(level), stencils_, nullptr, workers_, exchange_, change.data(),
            trial_.data());
    const Array<float>& diagonal = op(level).diagonal();
    for_each_index(workers_, size,
                   [&](std::size_t i) { trial_[i] = plate[i] + (diagonal[i / 3] > 0 ? trial_[i] : 0.0); });
    take_if_lower();
    if (report.start_energy > hopeful * energy_below) {
      prolong_with_normals(lattice(level - 1), lattice(level), workers_, below.data(), here_.normal.data(),
                           trial_.data());
      for_each_index(workers_, size, [&](std::size_t i) {
        if (!(diagonal[i / 3] > 0)) trial_[i] = plate[i];
      });
      take_if_lower();
    }
  }
  std::swap(here_, there_);
}

CurvatureLevelReport CurvatureSystem::solve_level(int level, const Array<double>& plate) {
  CurvatureLevelReport report;
  report.level = level;
  if (level < base_) return report;
  const bool finest = level + 1 == int(lattices_.size());
  choose_start(level, plate, report);
  const Enough accurate{0, options_.step_tolerance}, near{plain_decrement, 0},
      damped_enough{damped_decrement, 0};
  const Array<double> start = surface_;
  const CurvatureLevelReport fresh = report;

  // Plain steps first, on every level: where they fail on a coarse one, they may do on a finer one.
  const int patience = finest && mode_ == Mode::damped ? short_patience : long_patience;
  minimize(level, Mode::plain, finest ? accurate : near, patience, report);
  if (!settled(report) || mode_ != Mode::plain) {
    const Found plain = found();
    const CurvatureLevelReport plain_report = std::exchange(report, fresh);
    surface_ = start;
    minimize(level, Mode::damped, damped_enough, 0, report);
    if (finest) polish(level, report);
    mode_ =
        settled(plain_report) && plain_report.energy <= as_low * report.energy ? Mode::plain : Mode::damped;
    if (mode_ == Mode::plain) {
      restore(plain);
      report = plain_report;
    }
  }
  plate_below_.assign(plate.begin(), plate.begin() + std::ptrdiff_t(surface_.size()));
  if (finest) {
    if (hold_.any()) finish_hold(level, report);
    if (epsilon_ > 0) release(level, report);
    if (!(report.energy <= report.plate_energy)) fall_back(level, plate, report);
    if (options_.energy == Energy::minimum_variation) vary(level, report);
  }
  return report;
}

// Steps may end in a fold; then the thin plate's surface is the better one.
void CurvatureSystem::fall_back(int level, const Array<double>& plate, CurvatureLevelReport& report) {
  surface_.assign(plate.begin(), plate.begin() + std::ptrdiff_t(3 * lattice(level).size()));
  energy_ = op(level).linearize(surface_.data(), &here_);
  report.energy = op(level).bending();
  report.converged = report.accurate = false;
}

// After a step within a tolerance: other weights, another energy.
void CurvatureSystem::adapt_hold(int level) {
  hold_.adapt(surface_);
  shared_.weights = hold_.weights();
  anderson_.reset();
  energy_ = op(level).linearize(surface_.data(), &here_);
}

// From here on held control vertices stay where they are, at most at the tolerance.
void CurvatureSystem::finish_hold(int level, CurvatureLevelReport& report) {
  shared_.unknowns = hold_.without_held();
  shared_.weights.clear();
  if (!hold_.adapts()) return;
  hold_.enforce(surface_);
  follow(level, report);
}

// A few plain steps after control vertices have been moved; without them where they do not settle.
void CurvatureSystem::follow(int level, CurvatureLevelReport& report) {
  energy_ = op(level).linearize(surface_.data(), &here_);
  const Found moved = found();
  CurvatureLevelReport followed = report;
  followed.converged = false;
  minimize(level, Mode::plain, {0, options_.step_tolerance}, short_patience, followed);
  if (followed.converged && followed.energy <= moved.energy)
    report = followed;
  else
    restore(moved);
}

// One step in which interpolated control vertices take part, drawn to their places as much as a control edge is stiff;
// none goes further than epsilon. Then the surface follows.
void CurvatureSystem::release(int level, CurvatureLevelReport& report) {
  const Unknowns fixed = shared_.unknowns;
  Unknowns freed = fixed;
  for (Index v = 0; v < mesh_.input_vertices; ++v) {
    const bool held = fixed.vertex[std::size_t(v)] || mesh_.feature_vertex[std::size_t(v)] ||
                      mesh_.ring(v).empty() || mesh_.vertex_place(v) != Place::inside;
    if (!held) freed.vertex[std::size_t(v)] = freed.any_vertex = true;
  }
  const std::vector<Vec3> places = mesh_.positions;
  for (int round = 0; round < release_rounds; ++round) {
    shared_.unknowns = freed;
    shared_.weights.assign(places.size(), 0.0);
    shared_.targets = places;
    for (std::size_t v = 0; v < places.size(); ++v)
      if (freed.vertex[v] && !fixed.vertex[v])
        shared_.weights[v] = release_pull * curvature_weight_unit(mesh_);
    energy_ = op(level).linearize(surface_.data(), &here_);
    linearize_below(level);
    damp(level, {});
    StepReport ignored;
    solve_step(level, ignored);
    for (std::size_t v = 0; v < places.size(); ++v) {
      if (!freed.vertex[v] || fixed.vertex[v]) continue;
      const Eigen::Map<const Vec3> normal(here_.normal.data() + 3 * v);
      Eigen::Map<Vec3> p(surface_.data() + 3 * v);
      Vec3 offset = p + step_[v] * normal - places[v];
      const double length = offset.norm();
      if (length > release_aim * epsilon_) offset *= release_aim * epsilon_ / length;
      p = places[v] + offset;
    }
    shared_.unknowns = fixed;
    shared_.weights.clear();
    follow(level, report);
  }
}

// Plain steps from where damped ones have ended, if they go on from there.
void CurvatureSystem::polish(int level, CurvatureLevelReport& report) {
  if (!report.converged) return;
  const Found damped = found();
  CurvatureLevelReport polished = report;
  polished.converged = false;
  minimize(level, Mode::plain, {0, options_.step_tolerance}, polishing_patience, polished);
  if (polished.converged && polished.energy <= as_low * report.energy)
    report = polished;
  else
    restore(damped);
}

bool CurvatureSystem::settled(const CurvatureLevelReport& report) const {
  return report.converged && report.energy <= report.plate_energy;
}

// From the surface of least total curvature to that of least variation of curvature, by Levenberg-Marquardt steps: the
// matrix of total curvature, which knows no long waves that cost nothing, damps them.
void CurvatureSystem::vary(int level, CurvatureLevelReport& report) {
  double square = 0, area = 0;  // total curvature, and the area
  const std::size_t points = lattice(level).size();
  const auto measure = [&](const Array<float>& shape) {
    square = sum(workers_, points, [&](std::size_t i) {
      const float* m = &shape[4 * i];
      return double(m[3]) * m[3] * (double(m[0]) * m[0] + double(m[1]) * m[1] + double(m[2]) * m[2]);
    });
    area = sum(workers_, points, [&](std::size_t i) { return double(shape[4 * i + 3]) * shape[4 * i + 3]; });
  };
  measure(here_.shape);
  if (!(square > flat)) return;
  shared_.energy = CurvatureEnergy::minimum_variation;
  shared_.damping = 0;
  energy_ = op(level).linearize(surface_.data(), &here_);
  report.start_variation = energy_;
  report.converged = false;
  LocalDamping damping(lattice(level), shared_.unknowns, workers_);
  double damping_share = first_share;
  int rejections = 0;
  for (int steps = 0; steps < options_.max_steps && rejections < most_rejections; ++steps) {
    report_progress(level, report);
    // near a sphere nothing varies: what is left of the energy is measured by the curvature itself
    const double scale = energy_ + still * square / area;
    shared_.damping = damping_share * scale / square;
    op(level).linearize(surface_.data(), &here_);
    linearize_below(level);
    damp(level, damping.mu());
    StepReport& step = report.steps.emplace_back();
    step.variation = true;
    step.energy = energy_;
    const double reduction = solve_step(level, step);
    step.decrement = std::sqrt(reduction / scale);
    op(level).predict(here_.shape, step_.data(), predicted_);
    bool accepted = false;
    for (step.length = 1; step.length >= least_length && !accepted; step.length /= 2) {
      const double energy = try_step(level, step.length);
      if (step.length == 1)
        damping.judge(predicted_, here_, there_, rejections, steps - rejections, step.decrement);
      if (!(energy <= energy_ + slack * step.decrement * scale) && !(step.decrement < variation_late))
        continue;
      const double gain = reduction > 0 ? (energy_ - energy) / reduction : 1;
      std::swap(surface_, trial_);
      std::swap(here_, there_);
      energy_ = energy;
      accepted = true;
      if (step.length < 1)
        damping_share *= 2;
      else if (gain > 0.5)
        damping_share = std::max(damping_share / 4, least_share);
      break;
    }
    if (!accepted) {
      step.length = 0;
      damping_share = std::max(4 * damping_share, first_share);
      ++rejections;
      op(level).linearize(surface_.data(), &here_);
      continue;
    }
    measure(here_.shape);
    step.movement = step.length * largest(workers_, points, [&](std::size_t i) { return step_[i]; });
    report.converged =
        step.decrement <= (steps < variation_patience ? variation_decrement : late_variation_decrement) ||
        step.movement <= options_.step_tolerance;
    report.accurate = step.movement <= options_.step_tolerance;
    if (report.converged) break;
  }
  report.variation = energy_;
  shared_.energy = CurvatureEnergy::total_curvature;
  shared_.damping = 0;
}

void CurvatureSystem::minimize(int level, Mode mode, const Enough& enough, int patience,
                               CurvatureLevelReport& report) {
  LocalDamping damping(lattice(level), shared_.unknowns, workers_);
  anderson_.reset();
  trial_.resize(3 * lattice(level).size());
  if (!is_linearized_) energy_ = op(level).linearize(surface_.data(), &here_);
  is_linearized_ = false;
  int rejections = 0;
  double last = 0;
  bool last_but_one = false;
  for (int steps = 0; steps < options_.max_steps && rejections < most_rejections; ++steps) {
    if ((report.converged = energy_ < flat)) break;
    report_progress(level, report);
    linearize_below(level);
    damp(level, damping.mu());
    StepReport& step = report.steps.emplace_back();
    step.energy = energy_;
    step.decrement = std::sqrt(solve_step(level, step) / energy_);
    if (!advance(level, step, mode == Mode::damped ? &damping : nullptr, rejections, steps - rejections)) {
      if (mode == Mode::plain) break;
      ++rejections;
      last = 0;
      continue;
    }
    // Steps gain by a ratio that the last two tell, and with it what is left.
    const double ratio = last > 0 ? step.decrement / last : 1;
    const double trusted = ratio * (last_but_one ? 1 : first_ratio);
    const double ahead = trusted < regular ? trusted / (1 - trusted) : 1;
    last_but_one = last > 0;
    last = step.decrement;
    if (hold_.adapts() && !shared_.weights.empty()) {
      adapt_hold(level);
      last = 0;
    }
    report.converged =
        enough.decrement > 0 ? step.decrement <= enough.decrement : ahead * step.movement <= enough.movement;
    report.accurate = ahead * step.movement <= options_.step_tolerance;
    report.converged &= shared_.weights.empty() || !hold_.adapts() || hold_.holds(surface_);
    if (report.converged) break;
    if (mode == Mode::plain && steps + 1 >= patience && step.decrement > plain_decrement) break;
  }
  report.energy = op(level).bending();
}

// Nobody knows how many steps there will be; most runs take four.
void CurvatureSystem::report_progress(int level, const CurvatureLevelReport& report) {
  monitor_.check_cancelled();
  if (level + 1 < int(lattices_.size())) return;
  const double steps = double(report.steps.size());
  monitor_.report(Phase::solve, steps_begin + (steps_end - steps_begin) * steps / (steps + 4));
}

// The step h of K h = force, in step_; returns h . K h, by which it would lower the energy.
double CurvatureSystem::solve_step(int level, StepReport& report) {
  const std::size_t points = lattice(level).size(), index = std::size_t(level - base_);
  step_.assign(points, 0.0);
  hierarchy_.refresh(index, true);
  PcgState& state = hierarchy_.state();
  std::copy(here_.force.begin(), here_.force.end(), state.residual.begin());
  PcgLimits limits;
  limits.tolerance = inner_accuracy;
  limits.from_start = true;
  limits.max_iterations = options_.max_iterations;
  const LevelSolve solved = hierarchy_.solve(index, limits, step_.data(), [](const PcgResult&) {});
  report.iterations = solved.iterations;
  report.residual = solved.residual;
  report.direct = solved.direct;
  const double square = sum(workers_, points, [&](std::size_t i) { return here_.force[i] * step_[i]; });
  return std::max(0.0, square);
}

// Goes along step_ as far as the energy allows; false: nowhere.
bool CurvatureSystem::advance(int level, StepReport& step, LocalDamping* damping, int rejections, int steps) {
  if (step.decrement < accelerated) anderson_.mix(op(level), workers_, step_);
  if (damping) op(level).predict(here_.shape, step_.data(), predicted_);
  const bool is_late = !damping || step.decrement < late;
  for (step.length = 1; step.length >= least_length; step.length /= 2) {
    const double energy = try_step(level, step.length);
    step.movement = step.length * largest(workers_, step_.size(), [&](std::size_t i) { return step_[i]; });
    if (step.length == 1 && !is_late &&
        damping->judge(predicted_, here_, there_, rejections, steps, step.decrement))
      anderson_.reset();
    if (!std::isfinite(energy) || (!is_late && energy > energy_ * (1 + slack * step.decrement))) continue;
    anderson_.took(step.length);
    std::swap(surface_, trial_);
    std::swap(here_, there_);
    energy_ = energy;
    return true;
  }
  step.length = 0;
  anderson_.reset();
  op(level).linearize(surface_.data(), &here_);
  return false;
}

double CurvatureSystem::try_step(int level, double length) {
  for_each_index(workers_, surface_.size(),
                 [&](std::size_t i) { trial_[i] = surface_[i] + length * step_[i / 3] * here_.normal[i]; });
  return op(level).linearize(trial_.data(), &there_);
}

}  // namespace fairing
