// SPDX-License-Identifier: GPL-3.0-or-later
// The plate, and what holds its control vertices, in turn. Each round solves for the surface with
// loads and weights as they are, and corrects these.
//
// Loads take what pads leave of the forces (hold/load_steps.h). A control vertex on a spring of
// weight w gives way: with s the stiffness of the surface there, the correction for a force r is
// (M + (s / w) T)^-1 (1 + s / w) r, with T the total of each hat.
//
// Weights. Those that keep vertices within tolerances are corrected by HoldInSpace.
//
// What a solve has left is foreseen: its residual r rests on the control vertices as H^T r, with H the
// cardinal surfaces. In their place stands the prolongation from the control vertices, so that
// solves between corrections may be short.
//
// Couples take what is left of the slopes that fixed normals forbid (hold/couples.h), which is read
// off the surface.
//
// All corrections are accelerated as one: each shifts what the others have to do.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "hold/load_steps.h"
#include "parallel/reductions.h"
#include "thin_plate/run.h"

namespace fairing {
namespace {

// What each solve but the last leaves of the error that it finds: what it then leaves of forces and
// of ways is foreseen. On 151 runs on pads finest levels took 1,018 iterations; 988 with 0.35 and 975
// with 0.5, but solves that begin anew so often pass for slow ones, and even meshes take blocks.
constexpr double solve_gain = 0.25;
// The same where that cannot be foreseen.
constexpr double solve_gain_unforeseen = 0.1;
// What a correction leaves of the forces, before two of them have said it; and the least of it that
// is believed.
constexpr double first_ratio = 0.3, least_ratio = 0.05;
// Of the way to go, for the progress: nobody knows how many iterations the rounds will take.
constexpr double left_by_iteration = 0.9;
// Of what loads carry, relative: what the forces left may be below the finest level, where loads are
// starts only.
constexpr double coarse_force_tolerance = 2e-2;
// Of a tolerance: what the last correction is to come to.
constexpr double last_correction_aim = 0.5;
// Corrections a level, of loads alone and where couples hold normals.
constexpr int most_corrections = 16, most_corrections_with_couples = 32;
// The duality gap, relative to the energy, that will do below the finest level: the next level
// changes as much.
constexpr double coarse_plate_gap = 1e-2;
// Of vertices placed on their balls: turns, and a gap after which no further one closes it.
constexpr int most_placed_turns = 6;
constexpr double largest_placed_gap = 1e-2;
// Of what loads carry, relative: with so much left the gap of placed vertices is known.
constexpr double settled_force = 0.03;
// Rounds with new weights for tolerances; the second where a round costs little: below the finest
// level, or with a factor.
constexpr int most_rounds = 16, most_cheap_rounds = 60;

// What is left of the force on a control vertex leaves as much of its spot. With 2e-3 positions are
// within 5.3e-5 of the mesh's size on 36 smooth and rough meshes (5e-4: within 5e-6, for a sixth more
// iterations and twice those of a drag); who asks for an exact surface gets exact loads.
constexpr double coarsest_force_tolerance = 2e-3;
double force_tolerance(double relative_residual) {
  return std::clamp(10 * std::sqrt(relative_residual), 1e-6, coarsest_force_tolerance);
}

// Of fixed normals, radians: a twentieth of a degree where forces are as rough as they may be.
constexpr double angle_per_force = 0.4, coarse_angle = 2e-2;

// Of the forces and slopes that corrections are to take off, how much is left.
struct LoadsLeft {
  double now = 0, before = 0;  // forces and slopes together, in the norm of M
  double ratio = first_ratio;  // what a correction leaves of it
  // Of a tangent plane from a fixed one, radians: a normal may look to the wrong side.
  double tilt = 0;

  void compare() {
    if (before > 0 && now > 0) ratio = std::clamp(now / before, least_ratio, 1.0);
    before = now;
  }
};

}  // namespace

// One level's rounds.
struct ThinPlateSolver::Rounds {
  Run& run;
  int level;
  const PcgLimits& limits;
  HoldInSpace* constraint;  // or null

  Pads* pads = run.solver.supports_.pads();
  Couples* couples = run.solver.supports_.couples(level);
  LoadSteps<3> steps =
      load_steps<3>(pads, constraint ? constraint->comparable(pads) : std::vector<double>{},
                    couples ? couples->mass() : Moments{});
  Loads forces = Loads(run.state.loads.size(), Vec3::Zero());  // left at control vertices on pads
  // Of a whole solve: what the residual is to lay on control vertices, and where these are to be.
  struct {
    Loads rest;
    std::vector<double> vertices;
    bool believed = true, checked = false;
  } foreseen{};
  std::vector<Vec3> pulls{};  // that hold vertices placed on their balls; empty: none is placed
  Multipliers<3> correction{};
  LoadsLeft left{};
  Run::Solved solved{run.report_of(level), {}};
  double gain = 0;     // of all solves, as a logarithm of residuals
  bool whole = false;  // whether the solve goes as far as is asked

  ThinPlateLevels& levels() { return run.levels(); }
  const ThinPlateShared& shared() { return levels().shared(); }
  const ThinPlateOptions& options() const { return run.solver.options_; }
  LevelReport& report() { return solved.report; }
  double* x() { return run.x.data(); }
  std::span<const Vec3> targets() const {
    return constraint ? constraint->aims() : run.data.targets;
  }
  bool top() const { return level == run.top(); }
  bool places() const { return !pulls.empty(); }
  double wanted_gap() const { return top() ? gap_wanted : coarse_plate_gap; }

  // r <- Omega phi f + P goal - (K + P) x on the unknowns; the forces left at the control vertices apart.
  void residual(const double* x, double* r) {
    if (!pads && !places()) {
      levels().residual(level, targets(), x, r);
    } else {
      levels().apply_with(level, pads ? pads->rows() : shared().unknowns, x, r);
      for_each_index(levels().workers(), run.size(level), [&](std::size_t i) { r[i] = -r[i]; });
      levels().add_pull(level, r);
      if (pads) pads->add_loads(run.state.loads, r);
      if (places()) take_pulls(r);
      take_point_forces<3>(
          shared().unknowns, shared().weights, pads, run.state.loads,
          [&](std::size_t v) -> Vec3 {
            return is_placed(v) ? Vec3(pulls[v] / shared().weights[v])
                                : Vec3(targets()[v] - Eigen::Map<const Vec3>(x + 3 * v));
          },
          forces, r);
    }
    if (couples) couples->add(run.state.moments, r);
    for (std::size_t i = 0; i < run.forces.size(); ++i) r[i] += run.forces[i];
  }

  // Placed vertices do not give way: what their rows ask for is the force that holds them there.
  void take_pulls(const double* r) {
    std::fill(pulls.begin(), pulls.end(), Vec3::Zero());
    for (std::size_t v = 0; v < pulls.size(); ++v) {
      if (!constraint->placed(v)) continue;
      pulls[v] = -Eigen::Map<const Vec3>(r + 3 * v);
      if (pads && pads->under(v)) pulls[v] += pads->total(v) * run.state.loads[v];
    }
  }

  void take_residual() { residual(x(), run.r.data()); }

  void solve() {
    PcgLimits now = limits;
    if (!whole && !limits.from_start) {
      now.from_start = true;
      now.tolerance =
          std::max(limits.tolerance, foreseen.believed ? solve_gain : solve_gain_unforeseen);
      // Afterwards something has to move: forces that are read again say nothing.
      if (!constraint && report().pad_corrections == 0) now.enough = limits.tolerance;
    }
    take_rest();
    const Loads forces_before = forces, rest_before = foreseen.rest;
    const double begun = norm(levels().workers(), run.size(level), run.r.data());
    const int before = report().iterations;
    const LevelSolve solve = levels().solve(
        level, now, {[&](const double* y, double* r) { residual(y, r); }, x(), run.r.data()},
        [&](const PcgResult& so_far) {
          run.report_done(level, 1 - std::pow(left_by_iteration, before + so_far.iterations));
        });
    static_cast<LevelSolve&>(report()) = solve;
    report().iterations += before;
    if (now.from_start && !limits.from_start)
      take_scale(limits.residual_scale > 0 ? begun / limits.residual_scale : 0.0);
    if (solve.iterations > 0 && solve.residuals.back() > 0)
      gain += std::log(solve.residuals.front() / solve.residuals.back());
    if (places()) constraint->put_placed(x());
    if (places() || (pads && !solve.direct && !levels().op(level).single_precision_suffices()))
      take_residual();
    take_rest();
    if (!foreseen.checked && !solve.direct)
      check_rest(forces_before, rest_before,
                 norm(levels().workers(), run.size(level), run.r.data()) / begun);
    foresee();
  }

  // Vertices on springs give way to what rests on them.
  void take_rest() {
    Loads& rest = foreseen.rest;
    rest.assign(std::size_t(shared().mesh.vertex_count()), Vec3::Zero());
    if (report().direct || !foreseen.believed) return;
    levels().restrict_to_vertices(level, run.r.data(), rest);
    const std::vector<double>& stiffness = run.solver.supports_.stiffness();
    for (std::size_t v = 0; v < stiffness.size(); ++v)
      if (shared().unknowns.vertex[v] && !is_placed(v))
        rest[v] *= spring(v) / (spring(v) + stiffness[v]);
  }

  // Which forces loads leave does not depend on how far a solve goes, so what is foreseen of them
  // should not change. It does as the residual, where the prolongation is far from H: at borders with
  // stiff stencils. It is believed where it is now known better than by the vertices' own rows.
  void check_rest(const Loads& forces_before, const Loads& rest_before, double residual_left) {
    Loads& rest = foreseen.rest;
    foreseen.checked = true;
    double own = 0, all = 0;
    for (std::size_t v = 0; v < forces.size(); ++v) {
      const Vec3 change = forces[v] - forces_before[v];
      own += change.squaredNorm();
      all += (change - rest[v] + rest_before[v]).squaredNorm();
    }
    foreseen.believed = residual_left * std::sqrt(all) <= std::sqrt(own);
    if (!foreseen.believed) rest.assign(rest.size(), Vec3::Zero());
  }

  void foresee() {
    const Loads& rest = foreseen.rest;
    foreseen.vertices.assign(x(), x() + 3 * rest.size());
    for (std::size_t v = 0; v < rest.size(); ++v) {
      if (pads && pads->under(v)) forces[v] -= rest[v];
      if (is_placed(v))
        pulls[v] -= rest[v];
      else if (shared().unknowns.vertex[v] && spring(v) > 0)
        Eigen::Map<Vec3>(foreseen.vertices.data() + 3 * v) += rest[v] / spring(v);
    }
  }
  bool is_placed(std::size_t v) const { return places() && constraint->placed(v); }
  double spring(std::size_t v) { return shared().weights.empty() ? 0.0 : shared().weights[v]; }

  // Residuals are reported relative to the control polyhedron's, however far a solve was to go.
  void take_scale(double scale) {
    report().residual *= scale;
    for (double& r : report().residuals) r *= scale;
  }

  double wanted_force() const {
    return std::max(run.rough_force,
                    top() ? force_tolerance(options().relative_residual) : coarse_force_tolerance);
  }
  double wanted_tilt() const { return top() ? angle_per_force * wanted_force() : coarse_angle; }

  // Of the loads, and of their correction, in the norm of M: squares.
  struct Sizes {
    double left = 0, loads = 0;
  };
  Sizes correct_loads() {
    const Loads& loads = run.state.loads;
    Loads product;
    const std::vector<double> compliance_ratio = compliance_ratios(
        shared().unknowns, shared().weights, run.solver.supports_.stiffness(), *pads);
    pads->divide_by_mass<3>(forces, correction.loads, compliance_ratio);
    pads->multiply_mass<3>(loads, product);
    return {dot<3>(correction.loads, forces), dot<3>(loads, product)};
  }

  // Couples are tried out after a solve: the smoother is to know the whole of the surface first.
  Sizes correct_couples() {
    if (!couples->knows_compliance())
      run.solver.supports_.measure_couples(level, options().max_iterations);
    correction.moments = couples->correction(x());
    report().normal_angle = left.tilt = 0;
    Sizes out;
    for (std::size_t c = 0; c < couples->size(); ++c) {
      const double angle = couples->angle(c, x());
      report().normal_angle = std::max(report().normal_angle, angle);
      left.tilt = std::max(left.tilt, std::min(angle, std::numbers::pi - angle));
      out.left += couples->mass()[c].dot(correction.moments[c].cwiseAbs2());
      out.loads += couples->mass()[c].dot(run.state.moments[c].cwiseAbs2());
    }
    return out;
  }

  // Whether little enough is left at the points, and of the angles to fixed normals; `correction`
  // has what would take it off.
  bool loads_settled() {
    if (!pads && !couples) return true;
    const Sizes of_loads = pads ? correct_loads() : Sizes{},
                of_couples = couples ? correct_couples() : Sizes{};
    const double size = std::sqrt(std::max(0.0, of_loads.loads + of_couples.loads));
    left.now = std::sqrt(std::max(0.0, of_loads.left + of_couples.left));
    report().pad_force = size > 0 ? left.now / size : left.now > 0 ? 1.0 : 0.0;
    double force_norm = 0;
    for (const Vec3& f : forces) force_norm += f.squaredNorm();
    return left.tilt <= wanted_tilt() &&
           (report().pad_force <= wanted_force() || std::sqrt(force_norm) <= limits.noise);
  }

  // Whether one more correction will settle the loads, as the last ones did, or must do.
  bool loads_nearly_settled() {
    left.compare();
    return (left.ratio * report().pad_force <= last_correction_aim * wanted_force() &&
            left.ratio * left.tilt <= last_correction_aim * wanted_tilt()) ||
           corrections_left() <= 1;
  }
  int corrections_left() {
    return (couples ? most_corrections_with_couples : most_corrections) +
           report().constraint_rounds - report().pad_corrections;
  }

  // Below the finest level what a solve leaves is less than what the next level changes.
  bool is_start_only() const { return (pads || couples) && !constraint && !top(); }

  bool bounds_settled() {
    return !constraint ||
           constraint->settled(levels().energy(level, x()), wanted_gap(), foreseen.vertices.data());
  }
  int rounds_left() {
    return (top() && !report().direct ? most_rounds : most_cheap_rounds) -
           report().constraint_rounds;
  }

  void change(bool loads, bool bounds) {
    correction.bounds.clear();
    if (constraint) correction.bounds.assign(constraint->size(), 0.0);
    if (bounds) correction.bounds = constraint->correction(foreseen.vertices.data());
    const bool guesses = bounds && constraint->far();
    if (guesses) steps.forget();
    Multipliers<3> step = guesses ? correction : steps.change(correction);
    for (std::size_t v = 0; v < step.loads.size(); ++v) run.state.loads[v] += step.loads[v];
    for (std::size_t c = 0; c < step.moments.size(); ++c) run.state.moments[c] += step.moments[c];
    report().pad_corrections += loads;
    if (bounds) {
      constraint->change(step.bounds);
      take_weights();
    }
    if (!guesses) steps.took(std::move(step));
  }

  void take_weights() {
    ++report().constraint_rounds;
    levels().set_weights(constraint->weights(), level);
  }

  void run_rounds() {
    for (;;) {
      take_residual();
      solve();
      const bool loads = loads_settled();
      if ((whole || report().enough) && (loads || corrections_left() <= 0)) {
        report().converged = report().converged && loads;
        return;
      }
      if (loads && is_start_only()) return;
      const bool nearly = loads_nearly_settled(), was_whole = whole;
      const bool bounds = was_whole || bounds_settled();
      if (constraint && !top() && (pads || couples) && bounds && loads) return;
      const bool may_adapt = constraint && !was_whole && rounds_left() > 0;
      // A correction after the last solve may ask for less than that leaves: then nothing would move,
      // and forces be read that say nothing. Loads go on with solves that gain.
      whole = (was_whole && constraint) || ((bounds || !may_adapt) && (loads || nearly));
      const bool adapts = may_adapt && !whole;
      if (adapts && constraint->begin(foreseen.vertices.data()))
        take_weights();
      else if (!loads || adapts)
        change(!loads, adapts);
      if (constraint && whole && !was_whole && top()) {
        constraint->pin(x());
        take_weights();
      }
    }
  }

  // With vertices placed on their balls, as if they were fixed, but for where. False where the gap
  // does not close.
  bool run_placed() {
    constraint->place(x());
    pulls.assign(std::size_t(shared().mesh.vertex_count()), Vec3::Zero());
    take_weights();
    bool settled = false;  // where vertices are; from then on loads alone change
    for (int turns = 0;;) {
      take_residual();
      solve();
      constraint->take_pulls(pulls);
      const double energy = levels().energy(level, x());
      const bool loads = loads_settled();
      if (whole && (loads || corrections_left() <= 0)) {
        report().converged = report().converged && loads;
        constraint->finish(energy, x());
        return loads && constraint->gap() <= gap_wanted;
      }
      const bool nearly = loads_nearly_settled();
      const bool stands = settled || constraint->turn(energy, last_correction_aim * gap_wanted);
      if (turns > 0 && constraint->gap() > largest_placed_gap) return false;
      if (!stands && ++turns > most_placed_turns) return false;
      settled = stands && (loads || settled || report().pad_force < settled_force);
      whole = settled && (loads || nearly);
      constraint->put_placed(x());
      if (!stands) steps.forget();
      if (!loads) change(true, false);
    }
  }

  // Weights as they were.
  void leave_places() {
    constraint->leave_places();
    pulls.clear();
    whole = false;
    take_weights();
    steps.forget();
  }

  Run::Solved solve_all() {
    const bool tries_places = constraint && top() && constraint->is_stiff();
    if (!tries_places || !run_placed()) {
      if (tries_places) leave_places();
      run_rounds();
      if (constraint && top()) constraint->finish(levels().energy(level, x()), x());
    }
    if (constraint) {
      report().constraint_gap = constraint->gap();
      report().converged = report().converged && report().constraint_gap <= wanted_gap();
    }
    // Couples hold a tangent plane, whichever of its sides the surface turns up.
    if (couples && top())
      report().converged = report().converged && report().normal_angle <= largest_angle_left;
    solved.equivalent = report();
    if (gain > 0)
      solved.equivalent.iterations = int(-report().iterations * std::log(limits.tolerance) / gain);
    return solved;
  }
};

ThinPlateSolver::Run::Solved ThinPlateSolver::Run::solve_in_rounds(int level,
                                                                   const PcgLimits& limits,
                                                                   HoldInSpace* constraint) {
  solver.supports_.set_level(level);
  return Rounds{*this, level, limits, constraint}.solve_all();
}

}  // namespace fairing
