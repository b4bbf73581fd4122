// SPDX-License-Identifier: GPL-3.0-or-later
#include "paper/back_leg.h"

#include <cmath>
#include <utility>

#include "parallel/cancel.h"
#include "parallel/reductions.h"
#include "sparse/unknown_points.h"
#include "thin_plate/differences.h"

namespace fairing {
namespace {

using Coordinates = Eigen::Vector3d;

// Gauss-Seidel sweeps on K e = r without K: a step at one point changes the differences of the rings
// that hold it, and what they pull at the next point is read from these.
class Sweeps {
 public:
  Sweeps(const GridLevel& grid, const ThinPlateShared& shared, const Array<double>& residual)
      : plate_(grid, shared.stencils, shared.unknowns, shared.workers),
        residual_(residual),
        e_(residual.size()),
        moment_(3 * residual.size()) {
    fill_long(e_.data(), e_.size(), 0.0);
    fill_long(moment_.data(), moment_.size(), 0.0);
  }

  void sweep() {
    for (std::size_t p = 0; p < plate_.rings().points(); ++p) {
      stop_if_cancelled(p);
      if (!plate_.rings().is_unknown(Index(p))) continue;
      double diagonal = 0;
      const Coordinates rest = residual_at(Index(p), &diagonal);
      if (diagonal > 0) move(Index(p), rest / diagonal);
    }
  }

  double norm() const {
    double sum = 0;
    for (std::size_t p = 0; p < plate_.rings().points(); ++p) {
      stop_if_cancelled(p);
      if (plate_.rings().is_unknown(Index(p))) sum += residual_at(Index(p)).squaredNorm();
    }
    return std::sqrt(sum);
  }

  const Array<double>& correction() const { return e_; }

 private:
  using Column = PlateDifferences::Column;

  Eigen::Map<const Coordinates> e(Index p) const {
    return Eigen::Map<const Coordinates>(e_.data() + 3 * std::size_t(p));
  }

  // Of r - K e at an unknown; `diagonal`, if wanted: K's.
  Coordinates residual_at(Index p, double* diagonal = nullptr) const {
    Coordinates rest = Eigen::Map<const Coordinates>(residual_.data() + 3 * std::size_t(p));
    double own = 0;
    for (const RingPlaces::Place& place : plate_.places().of(p)) {
      const EnergyRows rows = plate_.rows(place.centre);
      if (rows.size() == 0) continue;
      const Column column = plate_.column(place.centre, rows, place.slot);
      const double* moment = moment_.data() + 9 * std::size_t(place.centre);
      for (std::size_t c = 0; c < 3; ++c) {
        rest -= column[c] * Eigen::Map<const Coordinates>(moment + 3 * c);
        own += column[c] * column[c];
      }
    }
    const MembraneWeights membrane = plate_.membrane(p);
    if (membrane.size() > 0) {
      const RingTable::Member* const members = plate_.rings().members(plate_.rings().about(p));
      rest -= membrane.total() * e(p);
      for (std::size_t k = 0; k < membrane.size(); ++k)
        rest += membrane[k] * e(RingTable::id_of(members[k + 1]));
      own += membrane.total();
    }
    if (diagonal) *diagonal = own;
    return rest;
  }

  void move(Index p, const Coordinates& by) {
    Eigen::Map<Coordinates>(e_.data() + 3 * std::size_t(p)) += by;
    for (const RingPlaces::Place& place : plate_.places().of(p)) {
      const EnergyRows rows = plate_.rows(place.centre);
      if (rows.size() == 0) continue;
      const Column column = plate_.column(place.centre, rows, place.slot);
      double* const moment = moment_.data() + 9 * std::size_t(place.centre);
      for (std::size_t c = 0; c < 3; ++c) Eigen::Map<Coordinates>(moment + 3 * c) += column[c] * by;
    }
  }

  const PlateDifferences plate_;
  const Array<double>& residual_;
  Array<double> e_;       // 3 a point, zero where it is no unknown
  Array<double> moment_;  // of the ring about a point: 3 differences of e, by 3 coordinates
};

}  // namespace

void solve_back_leg(ThinPlateLevels& levels, const PlateData& data, int sweeps,
                    const Monitor& monitor, Array<double>& x, std::vector<LevelReport>& reports,
                    const std::function<void(const double*)>& on_prediction) {
  const ThinPlateShared& shared = levels.shared();
  for (int level = levels.base(); level <= levels.top(); ++level) {
    const std::size_t size = 3 * levels.grid(level).size();
    const Array<double> below = std::exchange(x, Array<double>(size));
    levels.start(level, data, below, x);
    if (level == levels.top() && on_prediction) on_prediction(x.data());
    Array<double> residual(size), polyhedron(size);
    const double reference =
        levels.scales(level, data, {}, polyhedron.data(), residual.data()).residual;
    levels.residual(level, data.targets, {}, x.data(), residual.data());
    Sweeps gauss_seidel(levels.grid(level), shared, residual);
    LevelReport report;
    report.level = level;
    report.points = levels.grid(level).size();
    report.unknowns = levels.unknowns_of(level);
    report.iterations = sweeps;
    const auto note_residual = [&] {
      report.residuals.push_back(reference > 0 ? gauss_seidel.norm() / reference : 0.0);
    };
    note_residual();
    for (int sweep = 0; sweep < sweeps; ++sweep) {
      monitor.check_cancelled();
      gauss_seidel.sweep();
      note_residual();
    }
    for_each_index(shared.workers, size,
                   [&](std::size_t i) { x[i] += gauss_seidel.correction()[i]; });
    report.residual = report.residuals.back();
    report.converged = true;  // it does what it promises: so many sweeps
    reports.push_back(report);
  }
}

}  // namespace fairing
