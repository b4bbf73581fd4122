// SPDX-License-Identifier: GPL-3.0-or-later
// Folds that steps leave: they lie along the surface, so that no displacement along its normals undoes them.
#include <algorithm>

#include "execution/vectors.h"
#include "fair/curvature.h"
#include "fair/grow.h"
#include "fair/harmonic_fill.h"
#include "lattice/linear.h"

namespace fairing {
namespace {

constexpr int most_rounds = 3;
constexpr int rings = 2;               // around folds that are filled; one more each round
constexpr float held_damping = 0.05f;  // of what is filled: without any it may fold again
constexpr double dearest = 1.15;       // of the energy with folds
constexpr double burst = 0.01;         // of it: what a point may gain at most
constexpr int rings_of_burst = 4;

double point_energy(const CurvatureLevel::Surface& surface, std::size_t i) {
  const float* m = &surface.shape[4 * i];
  return double(m[3]) * m[3] * (double(m[0]) * m[0] + double(m[1]) * m[1] + double(m[2]) * m[2]);
}

}  // namespace

Folds CurvatureSystem::find_folds_of(int level) {
  return find_folds(lattice(level), workers_, surface_.data(), folded_faces_);
}

void CurvatureSystem::grow_marks(int level, int by, Array<float>& marks) {
  for (int r = 0; r < by; ++r) grow(lattice(level), workers_, shared_.fast_exchange, nullptr, marks);
}

// Goes the level's steps again, from its start filled anew where they ended in folds. What comes of it stands if there are
// fewer folds for about the same energy. A place whose energy bursts is left out from then on.
void CurvatureSystem::unfold(int level, const Array<double>& start, const CurvatureLevelReport& fresh,
                             CurvatureLevelReport& report) {
  const std::size_t points = lattice(level).size();
  Folds folds = find_folds_of(level);
  report.folds_before = report.folds = folds.count();
  if (report.folds == 0) return;
  const double bound = std::min(dearest * report.energy, report.plate_energy);
  Found best = found();
  Array<float> folded(points, 0.0f), marks, left_out(points, 0.0f);
  for (int round = 0; round < most_rounds && report.folds > 0; ++round) {
    mark_folds(lattice(level), surface_.data(), folds, marks);
    for_each_index(workers_, points, [&](std::size_t i) {
      folded[i] = std::max(folded[i], marks[i]) * (left_out[i] > 0 ? 0.0f : 1.0f);
    });
    if (std::find(folded.begin(), folded.end(), 1.0f) == folded.end()) break;
    marks = folded;
    grow_marks(level, rings + round, marks);
    surface_ = start;
    refill(level, marks);
    CurvatureLevelReport again = fresh;
    LocalDamping damping(lattice(level), shared_.unknowns, workers_);
    damping.hold(marks, held_damping);
    go_steps(level, &damping, {damped_decrement, 0}, options_.max_steps, 0, again);
    if (report.accurate) polish(level, again);
    folds = find_folds_of(level);
    again.folds_before = report.folds_before;
    again.folds = folds.count();
    if (again.folds < report.folds && again.energy <= bound && again.converged >= report.converged &&
        again.accurate >= report.accurate) {
      report = again;
      best = found();
    } else if (!leave_bursts_out(level, best.here, burst * report.energy, left_out)) {
      break;
    }
  }
  restore(best);
}

// Marked points anew, as the control mesh has them between those around.
void CurvatureSystem::refill(int level, const Array<float>& marks) {
  trial_.resize(surface_.size());
  refine_linearly(lattice(level), hold_.places(), workers_, trial_.data());
  fill_harmonically(lattice(level), hold_.any() ? hold_.without_held() : shared_.unknowns, marks,
                    trial_.data(), surface_.data());
  symmetrize(level, surface_);
}

// Adds what is around the points that have gained more energy than `most`; false: none has.
bool CurvatureSystem::leave_bursts_out(int level, const CurvatureLevel::Surface& before, double most,
                                       Array<float>& left_out) {
  Array<float> bursts(left_out.size());
  for_each_index(workers_, bursts.size(), [&](std::size_t i) {
    bursts[i] = point_energy(here_, i) > point_energy(before, i) + most ? 1.0f : 0.0f;
  });
  if (std::find(bursts.begin(), bursts.end(), 1.0f) == bursts.end()) return false;
  grow_marks(level, rings_of_burst, bursts);
  for_each_index(workers_, bursts.size(),
                 [&](std::size_t i) { left_out[i] = std::max(left_out[i], bursts[i]); });
  return true;
}

}  // namespace fairing
