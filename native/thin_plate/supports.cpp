// SPDX-License-Identifier: GPL-3.0-or-later
#include "thin_plate/supports.h"

#include <algorithm>
#include <utility>

#include "constraints/multipliers.h"
#include "parallel/reductions.h"

namespace fairing {
namespace {

// Loads converge with the square of the mesh width, which is halved.
constexpr double change_left_by_level = 0.25;

}  // namespace

PlateSupports::PlateSupports(const ChartMaker& charts, const ThinPlateOptions& options,
                             ThinPlateLevels& levels)
    : levels_(levels) {
  ThinPlateShared& shared = levels.shared();
  const Unknowns& unknowns = shared.unknowns;
  if (options.pad_size > 0)
    pads_ = std::make_unique<Pads>(shared.mesh, charts, unknowns, options.pad_size, shared.workers,
                                   levels.weights(levels.base()));
  if (pads_ && !pads_->any()) pads_.reset();
  if (!options.normals.empty() && levels.top() > 0)
    couples_ = std::make_unique<Couples>(shared.mesh, charts, options.normals, shared.workers);
  if (!unknowns.any_vertex) return;
  const Array<float> diagonal = thin_plate_diagonal(levels.grid(0), shared.stencils, unknowns,
                                                    shared.workers, shared.double_slots);
  for (Index v = 0; v < shared.mesh.vertex_count(); ++v)
    stiffness_.push_back(diagonal[v] > 0 ? double(diagonal[v]) : 1.0);
}

PlateState PlateSupports::unloaded() const {
  PlateState out;
  if (couples_) out.moments.assign(couples_->size(), Vec2::Zero());
  return out;
}

std::shared_ptr<const Hats> PlateSupports::hats(int level) {
  const GridLevel& grid = levels_.grid(level);
  if (pads_ && !(hats_ && &hats_->grid() == &grid)) hats_ = std::make_shared<Hats>(*pads_, grid);
  return hats_;
}

std::shared_ptr<const LevelCouples> PlateSupports::couples(int level) {
  if (!couples_ || level < std::min(Couples::first_level, levels_.top())) return nullptr;
  const GridLevel& grid = levels_.grid(level);
  if (!(level_couples_ && &level_couples_->grid() == &grid))
    level_couples_ = std::make_shared<LevelCouples>(*couples_, grid);
  return level_couples_;
}

void PlateSupports::start(int level, bool foretells, PlateState& state, Loads& forces_below) {
  if (pads_) start_loads(level, foretells, state.loads, forces_below);
  if (couples_) start_couples(level, state.moments);
}

// Loads are densities and hardly change between levels if hats have enough points; the samples of
// the hats do change. On the coarsest level they are so few that the product M f changes less than
// the integral of each load. On finer levels the change is a quarter of the previous one, which
// predicts the next, except for loads of vertices with weights.
void PlateSupports::start_loads(int level, bool foretells, Loads& loads, Loads& forces_below) {
  const int base = levels_.base();
  loads.resize(std::size_t(levels_.shared().mesh.vertex_count()));
  if (level <= base + 1) forces_below.clear();
  if (level == base) {
    std::fill(loads.begin(), loads.end(), Vec3::Zero());
    return;
  }
  if (level == base + 1) {
    Loads effect;
    hats(level - 1)->multiply_mass<3>(loads, effect);
    hats(level)->divide_by_mass<3>(effect, loads);
    return;
  }
  const auto below = hats(level - 1);
  for (std::size_t v = 0; v < loads.size(); ++v) loads[v] *= below->total(v);
  if (level > Couples::first_level && foretells) {
    const Loads before = std::exchange(forces_below, loads);
    for (std::size_t v = 0; v < before.size(); ++v)
      loads[v] += change_left_by_level * (loads[v] - before[v]);
  }
  const auto here = hats(level);
  for (std::size_t v = 0; v < loads.size(); ++v)
    if (here->under(v)) loads[v] /= here->total(v);
}

// Integrals of couples do not change.
void PlateSupports::start_couples(int level, Moments& moments) {
  if (const auto below = level > levels_.base() ? couples(level - 1) : nullptr)
    couples(level)->carry(*below, moments);
  else
    std::fill(moments.begin(), moments.end(), Vec2::Zero());
}

const Compliance& PlateSupports::compliance(int level, int max_iterations) {
  if (!compliance_) measure_couples(level, max_iterations);
  return *compliance_;
}

// Distant couples are tested in one solve, and again for each axis. Its convergence says nothing
// about the surface, so the smoother does not adapt to it.
void PlateSupports::measure_couples(int level, int max_iterations) {
  const auto here = couples(level);
  const std::vector<std::vector<std::size_t>> sets = couples_->sets_apart();
  std::vector<Eigen::Matrix2d> slopes(couples_->size(), Eigen::Matrix2d::Zero());
  Workers& workers = levels_.workers();
  Array<double> y(3 * levels_.grid(level).size()), r(y.size());
  PcgLimits rough;
  rough.tolerance = coarse_force_tolerance;  // slopes for corrections need no more
  rough.from_start = true;
  rough.max_iterations = max_iterations;
  rough.may_adapt = false;
  const auto each_of = [&](std::size_t first, auto&& visit) {
    for (std::size_t k = first; k < std::min(first + 3, 2 * sets.size()); ++k)
      for (const std::size_t c : sets[k / 2])
        visit(c, Eigen::Index(k - first), Eigen::Index(k % 2));
  };
  for (std::size_t first = 0; first < 2 * sets.size(); first += 3) {
    std::vector<Couple> trials(couples_->size(), Couple::Zero());
    each_of(first,
            [&](std::size_t c, Eigen::Index axis, Eigen::Index k) { trials[c](axis, k) = 1; });
    const auto residual = [&](const double* x, double* out) {
      levels_.op(level).apply(x, out);
      for_each_index(workers, y.size(), [&](std::size_t i) { out[i] = -out[i]; });
      here->add(trials, out);
    };
    for_each_index(workers, y.size(), [&](std::size_t i) { y[i] = 0; });
    residual(y.data(), r.data());
    levels_.solve(level, rough, {residual, y.data(), r.data()});
    each_of(first, [&](std::size_t c, Eigen::Index axis, Eigen::Index k) {
      slopes[c].col(k) = here->slopes(c, y.data()).row(axis).transpose();
    });
  }
  compliance_ = here->compliance(std::move(slopes));
}

}  // namespace fairing
