// SPDX-License-Identifier: GPL-3.0-or-later
#include "curvature/start.h"

#include <utility>

#include "base/roundoff.h"
#include "curvature/steps.h"
#include "parallel/reductions.h"
#include "transfer/point_normal.h"
#include "transfer/quadratic.h"

namespace fairing {
namespace {

// If the energy is this many times that of the level below, the polyhedron is tried (measured:
// tried always, a mirror ends at 2.5 times the energy; never, a bishop at 1.3 times).
constexpr double polyhedron_above = 10;

// The surface of `candidate`, from the number of a coordinate, at the unknowns, and of the plate
// elsewhere becomes iterate.current if it has less energy.
template <class Candidate>
void try_candidate(SurfaceIterate& it, const Array<double>& plate, CurvatureLevelReport& report,
                   Candidate&& candidate) {
  // zero, on every surface, for points that are not unknowns
  const Array<float>& diagonal = it.op().diagonal();
  Array<double>& trial = it.trial.points;
  for_each_index(it.workers(), plate.size(),
                 [&](std::size_t i) { trial[i] = diagonal[i / 3] > 0 ? candidate(i) : plate[i]; });
  it.system.symmetrize(it.level, trial);
  it.trial.functional = it.current.functional;
  it.system.linearize(it.level, it.trial);
  const double objective = it.op().objective();
  if (!(objective < (1 - roundoff) * report.start_energy)) return;
  report.start_energy = objective;
  std::swap(it.current, it.trial);
}

}  // namespace

void choose_start(SurfaceIterate& iterate, int level, const Pads* pads, const Array<double>& plate,
                  const Array<double>& plate_below, Reference reference,
                  std::span<const Vec3> given, CurvatureLevelReport& report) {
  const LinearizedSurface below = std::exchange(iterate.current, {});
  iterate.level = level;
  iterate.current.points = plate;
  iterate.system.symmetrize(level, iterate.current.points);
  iterate.linearize({CurvatureEnergy::total_curvature, pads});
  iterate.system.penalize(level, std::move(reference), iterate.current);
  report.plate_energy = report.start_energy = iterate.op().objective();
  // Rounding errors would decide between flat surfaces.
  if (report.start_energy < flat_energy) return;
  const GridLevel& grid = iterate.grid();
  Array<double>& trial = iterate.trial.points;
  trial.resize(plate.size());
  if (below.points.empty()) {
    if (given.size() == grid.size())
      try_candidate(iterate, plate, report, [&](std::size_t i) { return given[i / 3][i % 3]; });
    return;
  }
  const GridLevel& coarse = iterate.system.grid(level - 1);
  {
    Array<double> change(below.points.size());
    for_each_index(iterate.workers(), change.size(),
                   [&](std::size_t i) { change[i] = below.points[i] - plate_below[i]; });
    ElementSlots<double, 3> slots;
    prolong(coarse, grid, iterate.system.stencils(), nullptr, iterate.workers(), slots,
            change.data(), trial.data());
  }
  try_candidate(iterate, plate, report, [&](std::size_t i) { return plate[i] + trial[i]; });
  // Zero normals give the polyhedron.
  const auto try_refined = [&](const Array<double>& normal) {
    prolong_with_normals(coarse, grid, iterate.workers(), below.points.data(), normal.data(),
                         trial.data());
    try_candidate(iterate, plate, report, [&](std::size_t i) { return trial[i]; });
  };
  if (report.start_energy > incomparable_energy * below.energy)
    try_refined(below.linearization.normal);
  if (report.start_energy > polyhedron_above * below.energy)
    try_refined(Array<double>(below.points.size(), 0.0));
  iterate.current.held = below.held;  // densities, which hardly change between levels
}

}  // namespace fairing
