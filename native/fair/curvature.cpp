// SPDX-License-Identifier: GPL-3.0-or-later
// The levels: where steps start, and which ones are gone.
#include "fair/curvature.h"

#include <cmath>

#include "execution/vectors.h"
#include "fair/surface.h"
#include "transfer/point_normal.h"
#include "transfer/transfer.h"

namespace fairing {
namespace {

constexpr double real_gain = 1 - 1e-9;  // what rounding may not decide
constexpr double hopeful = 1.5;   // a start's energy, to the level below's, that needs no other beside it
constexpr double desperate = 10;  // one from which no other is worse
constexpr double nearby = 0.02;   // of the energy: its change where what preconditions may stay
constexpr double as_low = 1.01;   // as the energy by damped steps

constexpr int long_patience = 14, polishing_patience = 3;

class DisplacementTransfer final : public LevelTransfer {
 public:
  // `written`: the transfer as rows, or null.
  DisplacementTransfer(CurvatureShared& shared, const Stencils& stencils, const Lattice& coarse,
                       const Lattice& fine, const WrittenTransfer* written)
      : shared_(shared), stencils_(stencils), coarse_(coarse), fine_(fine), written_(written) {}
  void prolong(const float* x, float* y) override {
    if (written_) return written_->prolong<1>(x, shared_.workers, y);
    fairing::prolong(coarse_, fine_, stencils_, &shared_.unknowns, shared_.workers, shared_.fast_exchange, x,
                     y);
  }
  void restrict_to(const float* x, float* y) override {
    if (written_) return written_->restrict_to<1>(x, shared_.workers, y);
    fairing::restrict_to(coarse_, fine_, stencils_, shared_.unknowns, shared_.workers, shared_.fast_exchange,
                         x, y);
  }

 private:
  CurvatureShared& shared_;
  const Stencils& stencils_;
  const Lattice &coarse_, &fine_;
  const WrittenTransfer* written_;
};

HierarchyOptions hierarchy_options(const Unknowns& unknowns, const FairOptions& options) {
  HierarchyOptions out;
  out.smoother_degree = options.smoother_degree;
  out.always_factor = unknowns.any_vertex;
  out.cheap_factor = direct_limit_of_steps;
  return out;
}

}  // namespace

CurvatureSystem::CurvatureSystem(const ControlMesh& mesh, const std::vector<CurvedOn>& levels, int base,
                                 const Stencils& stencils, const Unknowns& unknowns,
                                 const FairOptions& options, ControlHold hold, double epsilon,
                                 Mirrors mirrors, Workers& workers, Monitor& monitor)
    : mesh_(mesh),
      base_(base),
      stencils_(stencils),
      options_(options),
      workers_(workers),
      monitor_(monitor),
      hold_(std::move(hold)),
      epsilon_(epsilon),
      mirrors_(std::move(mirrors)),
      shared_{mesh, unknowns, CurvatureEnergy::total_curvature, workers},
      hierarchy_(workers, hierarchy_options(unknowns, options)) {
  for (const CurvedOn& level : levels) lattices_.push_back(level.lattice);
  for (int l = base; l < int(lattices_.size()); ++l) {
    operators_.push_back(std::make_unique<CurvatureLevel>(shared_, lattice(l)));
    if (l > base)
      transfers_.push_back(std::make_unique<DisplacementTransfer>(
          shared_, stencils, lattice(l - 1), lattice(l), levels[std::size_t(l)].to_coarser));
    hierarchy_.add(*operators_.back(), l > base ? transfers_.back().get() : nullptr,
                   count_unknowns(lattice(l), unknowns));
  }
  hierarchy_.complete();
  folded_faces_ = folded_control_faces(mesh, hold_.places(), workers);
  shared_.weights = hold_.weights();
  if (hold_.any()) shared_.targets.assign(hold_.places().begin(), hold_.places().end());
}

CurvatureSystem::~CurvatureSystem() = default;

// Rounding is not alike on both sides of a mirror, and steps over crumpled places amplify it.
void CurvatureSystem::symmetrize(int level, Array<double>& x) {
  for (const Mirror* mirror : mirrors_)
    mean_with_image(lattice(level), *mirror, shared_.unknowns, workers_, x.data());
}

void CurvatureSystem::take_plate(int level, const Array<double>& plate) {
  surface_.resize(3 * lattice(level).size());
  for_each_index(workers_, surface_.size(), [&](std::size_t i) { surface_[i] = plate[i]; });
  symmetrize(level, surface_);
}

// The thin plate's surface, or the one that the level below has found: as its change of the plate, bulged along its
// normals, or, where these are crumpled, as a polyhedron.
void CurvatureSystem::choose_start(int level, const Array<double>& plate, CurvatureLevelReport& report) {
  const std::size_t size = 3 * lattice(level).size();
  const Array<double> below = std::move(surface_);
  const double energy_below = energy_;
  take_plate(level, plate);
  energy_ = op(level).linearize(surface_.data(), &there_);
  report.plate_energy = report.start_energy = op(level).bending();
  is_linearized_ = true;
  if (!below.empty()) {
    trial_.resize(size);
    const auto take_if_lower = [&] {
      symmetrize(level, trial_);
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
    const auto try_refined = [&](double enough, const Array<double>& normal) {
      if (!(report.start_energy > enough * energy_below)) return;
      prolong_with_normals(lattice(level - 1), lattice(level), workers_, below.data(), normal.data(),
                           trial_.data());
      for_each_index(workers_, size, [&](std::size_t i) {
        if (!(diagonal[i / 3] > 0)) trial_[i] = plate[i];
      });
      take_if_lower();
    };
    try_refined(hopeful, here_.normal);
    try_refined(desperate, Array<double>(below.size(), 0.0));
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
    unfold(level, start, fresh, report);
    if (hold_.any()) finish_hold(level, report);
    if (epsilon_ > 0) release(level, report);
    if (!(report.energy <= report.plate_energy)) fall_back(level, plate, report);
    if (options_.energy == Energy::minimum_variation) vary(level, report);
    found_folds_ = report.folds = find_folds_of(level).count();
    found_energy_ = report.energy;
    sound_ = report.converged;
  }
  return report;
}

// Where steps had to be damped, or control vertices take part in them, all levels are needed.
bool CurvatureSystem::can_move() const {
  return sound_ && mode_ == Mode::plain && !hold_.any() && !(epsilon_ > 0);
}

void CurvatureSystem::leave_plate(const Array<double>& plate) {
  for_each_index(workers_, surface_.size(), [&](std::size_t i) { surface_[i] -= plate[i]; });
}

bool CurvatureSystem::solve_moved(const Array<double>& plate, Mirrors mirrors, CurvatureLevelReport& report) {
  const int level = int(lattices_.size()) - 1;
  mirrors_ = std::move(mirrors);
  folded_faces_ = folded_control_faces(mesh_, hold_.places(), workers_);
  for_each_index(workers_, surface_.size(), [&](std::size_t i) { surface_[i] += plate[i]; });
  symmetrize(level, surface_);
  energy_ = op(level).linearize(surface_.data(), &here_);
  is_linearized_ = true;
  report.level = level;
  report.plate_energy = NAN;  // nobody has asked
  report.start_energy = report.energy = op(level).bending();
  if (!(report.start_energy <= hopeful * found_energy_ + flat)) return false;
  is_near_ = std::abs(report.start_energy - found_energy_) <= nearby * found_energy_;
  report.converged = true;
  if (options_.energy == Energy::minimum_variation)
    vary(level, report);
  else
    minimize(level, Mode::plain, {0, options_.step_tolerance}, short_patience, report);
  report.folds_before = report.folds = find_folds_of(level).count();
  sound_ = report.converged && report.energy <= as_low * report.start_energy + flat &&
           report.folds <= found_folds_;
  found_energy_ = report.energy;
  return sound_;
}

// Steps may end in a fold; then the thin plate's surface is the better one.
void CurvatureSystem::fall_back(int level, const Array<double>& plate, CurvatureLevelReport& report) {
  take_plate(level, plate);
  energy_ = op(level).linearize(surface_.data(), &here_);
  report.energy = op(level).bending();
  report.converged = report.accurate = false;
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

}  // namespace fairing
