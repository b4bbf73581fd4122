// SPDX-License-Identifier: GPL-3.0-or-later
// What holds the plate, before the rounds that correct it (solve_in_rounds.cpp): how a level starts
// with loads and couples, what is left of the forces, and which slopes a couple makes.
#include <algorithm>
#include <utility>

#include "grid/ring.h"
#include "hold/couples.h"
#include "hold/hold_in_space.h"
#include "hold/load_steps.h"
#include "hold/strays.h"
#include "parallel/reductions.h"
#include "thin_plate/solver.h"

namespace fairing {
namespace {

// Loads converge as the square of the mesh width.
constexpr double change_left_by_level = 0.25;

// To what couples are tried out: slopes need no more to be corrected by.
constexpr double trial_tolerance = 0.03;

// While it lives, solves leave the smoother as it is.
class UnadaptedSmoother {
 public:
  explicit UnadaptedSmoother(Hierarchy& hierarchy)
      : hierarchy_(hierarchy), adapts_(hierarchy.is_adapting()) {
    hierarchy.set_adapting(false);
  }
  ~UnadaptedSmoother() { hierarchy_.set_adapting(adapts_); }
  UnadaptedSmoother(const UnadaptedSmoother&) = delete;
  UnadaptedSmoother& operator=(const UnadaptedSmoother&) = delete;

 private:
  Hierarchy& hierarchy_;
  const bool adapts_;
};

}  // namespace

// r <- Omega phi f - K x on the unknowns; the forces left at the control vertices apart.
void ThinPlateSolver::residual_on_pads(int level, std::span<const Vec3> targets, const double* x,
                                       HeldState& held, double* r) {
  const auto add_couples = [&] {
    if (has_couples(level)) couples_->add(held.moments, r);
  };
  if (!pads_ && !held.placed) {
    residual(level, targets, x, r);
    return add_couples();
  }
  apply_thin_plate(grid(level), shared_.double_rows, pads_ ? pads_->rows() : shared_.unknowns, {},
                   workers_, shared_.double_slots, x, r);
  for_each_index(workers_, 3 * grid(level).size(), [&](std::size_t i) { r[i] = -r[i]; });
  if (pads_) pads_->add_loads(held.loads, r);
  if (held.placed) take_pulls(r, held);
  take_point_forces<3>(
      shared_.unknowns, shared_.weights, pads_.get(), held.loads,
      [&](std::size_t v) -> Vec3 {
        return held.placed && held.placed->placed(v)
                   ? Vec3(held.pulls[v] / shared_.weights[v])
                   : Vec3(targets[v] - Eigen::Map<const Vec3>(x + 3 * v));
      },
      held.forces, r);
  add_couples();
}

// Placed vertices do not give way: what their rows ask for is the force that holds them there.
void ThinPlateSolver::take_pulls(const double* r, HeldState& held) const {
  held.pulls.assign(std::size_t(mesh_.vertex_count()), Vec3::Zero());
  for (std::size_t v = 0; v < held.pulls.size(); ++v) {
    if (!held.placed->placed(v)) continue;
    held.pulls[v] = -Eigen::Map<const Vec3>(r + 3 * v);
    if (pads_ && pads_->under(v)) held.pulls[v] += pads_->total(v) * held.loads[v];
  }
}

void ThinPlateSolver::start_held(int level, bool foretells, HeldState& held) {
  if (pads_) start_loads(level, foretells, held);
  if (couples_) start_couples(level, held.moments);
}

// Loads are densities and hardly change from level to level; what does is the hats' samples. The
// coarsest level has so few that M f, what loads do, changes less than the whole of each. Finer
// ones change by a quarter of what the level before has changed, which tells the next; but for loads
// that go with weights.
void ThinPlateSolver::start_loads(int level, bool foretells, HeldState& held) {
  Loads& loads = held.loads;
  loads.resize(std::size_t(mesh_.vertex_count()));
  if (level <= base_ + 1) held.coarse_forces.clear();
  if (level == base_) {
    std::fill(loads.begin(), loads.end(), Vec3::Zero());
    return;
  }
  pads_->set_level(grid(level - 1));
  if (level == base_ + 1) {
    Loads effect;
    pads_->multiply_mass<3>(loads, effect);
    pads_->set_level(grid(level));
    pads_->divide_by_mass<3>(effect, loads);
    return;
  }
  for (std::size_t v = 0; v < loads.size(); ++v) loads[v] *= pads_->total(v);
  if (level > level_of_first_loads && foretells) {
    const Loads before = std::exchange(held.coarse_forces, loads);
    for (std::size_t v = 0; v < before.size(); ++v)
      loads[v] += change_left_by_level * (loads[v] - before[v]);
  }
  pads_->set_level(grid(level));
  for (std::size_t v = 0; v < loads.size(); ++v)
    if (pads_->under(v)) loads[v] /= pads_->total(v);
}

bool ThinPlateSolver::leave_thrown_pads(int level, std::span<const Vec3> targets, const double* x) {
  if (!pads_) return false;
  bool any = false;
  const auto leave = [&](Index v) {
    any |= pads_->under(std::size_t(v));
    pads_->leave(std::size_t(v));
  };
  for (const Index v : thrown_stars(grid(level), workers_, targets, x)) {
    leave(v);
    visit_ring(grid(0), v, [&](Index u, std::size_t) { leave(u); });
  }
  return any;
}

// Couples stay what they are as a whole.
void ThinPlateSolver::start_couples(int level, Moments& moments) {
  const bool goes_on = level > base_ && has_couples(level - 1);
  if (!goes_on) std::fill(moments.begin(), moments.end(), Vec2::Zero());
  if (!has_couples(level)) return;
  if (goes_on) couples_->set_level(grid(level - 1));
  const std::vector<double> before = couples_->totals();
  couples_->set_level(grid(level));
  if (goes_on) couples_->carry(before, moments);
}

// Couples far apart are tried out in one solve, and others along each axis. How well that goes says
// nothing about the surface, which the smoother is to adapt to.
void ThinPlateSolver::measure_couples(int level) {
  const std::vector<std::vector<std::size_t>> sets = couples_->sets_apart();
  std::vector<Eigen::Matrix2d> slopes(couples_->size(), Eigen::Matrix2d::Zero());
  Array<double> y(3 * grid(level).size());
  PcgLimits rough;
  rough.tolerance = trial_tolerance;
  rough.from_start = true;
  rough.max_iterations = options_.max_iterations;
  const UnadaptedSmoother unadapted(hierarchy_);
  const auto each_of = [&](std::size_t first, auto&& visit) {
    for (std::size_t k = first; k < std::min(first + 3, 2 * sets.size()); ++k)
      for (const std::size_t c : sets[k / 2])
        visit(c, Eigen::Index(k - first), Eigen::Index(k % 2));
  };
  for (std::size_t first = 0; first < 2 * sets.size(); first += 3) {
    std::vector<Couple> trials(couples_->size(), Couple::Zero());
    each_of(first,
            [&](std::size_t c, Eigen::Index axis, Eigen::Index k) { trials[c](axis, k) = 1; });
    const auto residual = [&](const double* x, double* r) {
      operators_[std::size_t(level - base_)]->apply(x, r);
      for_each_index(workers_, y.size(), [&](std::size_t i) { r[i] = -r[i]; });
      couples_->add(trials, r);
    };
    for_each_index(workers_, y.size(), [&](std::size_t i) { y[i] = 0; });
    residual(y.data(), hierarchy_.state().residual.data());
    hierarchy_.solve(std::size_t(level - base_), rough, residual, y.data(),
                     [](const PcgResult&) {});
    each_of(first, [&](std::size_t c, Eigen::Index axis, Eigen::Index k) {
      slopes[c].col(k) = couples_->slopes(c, y.data()).row(axis).transpose();
    });
  }
  couples_->set_compliance(std::move(slopes));
}

}  // namespace fairing
