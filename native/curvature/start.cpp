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

// The candidates after the first. `below` is the solution on the level below; an accepted candidate
// becomes iterate.current.
class Candidates {
 public:
  Candidates(SurfaceIterate& iterate, const Array<double>& plate, CurvatureLevelReport& report)
      : it_(iterate), plate_(plate), diagonal_(iterate.op().diagonal()), report_(report) {
    it_.trial.points.resize(plate_size());
  }

  void try_change(const LinearizedSurface& below, const Array<double>& plate_below) {
    Array<double> change(below.points.size());
    for_each_index(it_.workers(), change.size(),
                   [&](std::size_t i) { change[i] = below.points[i] - plate_below[i]; });
    ElementSlots<double, 3> slots;
    prolong(coarse(), it_.grid(), it_.system.stencils(), nullptr, it_.workers(), slots,
            change.data(), trial().data());
    for_each_index(it_.workers(), plate_size(), [&](std::size_t i) {
      trial()[i] = plate_[i] + (is_unknown(i / 3) ? trial()[i] : 0.0);
    });
    accept_if_lower();
  }

  // Zero normals give the polyhedron.
  void try_refined(const Array<double>& below, const Array<double>& normal) {
    prolong_with_normals(coarse(), it_.grid(), it_.workers(), below.data(), normal.data(),
                         trial().data());
    for_each_index(it_.workers(), plate_size(), [&](std::size_t i) {
      if (!is_unknown(i / 3)) trial()[i] = plate_[i];
    });
    accept_if_lower();
  }

  void try_given(std::span<const Vec3> given) {
    for_each_index(it_.workers(), plate_size(), [&](std::size_t i) {
      trial()[i] = is_unknown(i / 3) ? given[i / 3][Eigen::Index(i % 3)] : plate_[i];
    });
    accept_if_lower();
  }

 private:
  const GridLevel& coarse() const { return it_.system.grid(it_.level - 1); }
  Array<double>& trial() { return it_.trial.points; }
  std::size_t plate_size() const { return 3 * it_.grid().size(); }
  bool is_unknown(std::size_t p) const { return diagonal_[p] > 0; }

  void accept_if_lower() {
    it_.system.symmetrize(it_.level, trial());
    it_.trial.functional = it_.current.functional;
    it_.system.linearize(it_.level, it_.trial);
    const double objective = it_.op().objective();
    if (!(objective < (1 - roundoff) * report_.start_energy)) return;
    report_.start_energy = objective;
    std::swap(it_.current, it_.trial);
  }

  SurfaceIterate& it_;
  const Array<double>& plate_;
  const Array<float>& diagonal_;  // zero, on every surface, for points that are not unknowns
  CurvatureLevelReport& report_;
};

}  // namespace

void start_at_plate(SurfaceIterate& iterate, int level, const Array<double>& plate) {
  iterate.level = level;
  iterate.current.points = plate;
  iterate.system.symmetrize(iterate.level, iterate.current.points);
}

void choose_start(SurfaceIterate& iterate, int level, Pads* pads, const Array<double>& plate,
                  const Array<double>& plate_below, std::span<const Vec3> given,
                  CurvatureLevelReport& report) {
  const LinearizedSurface below = std::exchange(iterate.current, {});
  start_at_plate(iterate, level, plate);
  iterate.linearize({CurvatureEnergy::total_curvature, pads});
  report.plate_energy = report.start_energy = iterate.op().objective();
  // Rounding errors would decide between flat surfaces.
  if (report.start_energy < flat_energy) return;
  Candidates candidates(iterate, plate, report);
  if (below.points.empty()) {
    if (given.size() == iterate.grid().size()) candidates.try_given(given);
    return;
  }
  candidates.try_change(below, plate_below);
  if (report.start_energy > incomparable_energy * below.energy)
    candidates.try_refined(below.points, below.linearization.normal);
  if (report.start_energy > polyhedron_above * below.energy)
    candidates.try_refined(below.points, Array<double>(below.points.size(), 0.0));
  iterate.current.held = below.held;  // densities, which hardly change between levels
}

}  // namespace fairing
