// SPDX-License-Identifier: GPL-3.0-or-later
#include "thin_plate/back_leg.h"

#include <cmath>

#include "thin_plate/matrix.h"

namespace fairing {
namespace {

using RowMatrix = Eigen::SparseMatrix<double, Eigen::RowMajor>;
using Columns = Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>;

// One sweep on K e = r, e updated in place.
void gauss_seidel(const RowMatrix& k, const Columns& r, Columns& e) {
  for (Eigen::Index i = 0; i < k.rows(); ++i) {
    Eigen::RowVector3d rest = r.row(i);
    double diagonal = 1;
    for (RowMatrix::InnerIterator entry(k, i); entry; ++entry) {
      if (entry.col() == i)
        diagonal = entry.value();
      else
        rest -= entry.value() * e.row(entry.col());
    }
    e.row(i) = rest / diagonal;
  }
}

}  // namespace

void solve_back_leg(ThinPlateSolver& system, std::span<const Vec3> targets, int sweeps,
                    Array<double>& x, std::vector<LevelReport>& reports,
                    const std::function<void(const double*)>& on_prediction) {
  for (int level = system.base(); level <= system.top(); ++level) {
    system.start_level(level, targets, system.surface_below(level, x), x);
    if (level == system.top() && on_prediction) on_prediction(x.data());
    const ThinPlateShared& shared = system.shared();
    const AssembledSystem assembled = assemble_thin_plate(
        system.grid(level), shared.stencils, shared.unknowns, shared.weights, shared.workers);
    const RowMatrix k = assembled.matrix;
    const std::vector<Index>& points = assembled.unknown_points;
    Array<double> residual(3 * system.grid(level).size());
    system.residual(level, targets, x.data(), residual.data());
    Columns r(Eigen::Index(points.size()), 3), e = Columns::Zero(Eigen::Index(points.size()), 3);
    for (std::size_t i = 0; i < points.size(); ++i)
      for (std::size_t a = 0; a < 3; ++a)
        r(Eigen::Index(i), Eigen::Index(a)) = residual[3 * std::size_t(points[i]) + a];
    const double reference = system.reference_residual(level, targets);
    LevelReport report;
    report.level = level;
    report.points = system.grid(level).size();
    report.unknowns = points.size();
    report.iterations = sweeps;
    const auto relative = [&](double norm) { return reference > 0 ? norm / reference : 0.0; };
    report.residuals.push_back(relative(r.norm()));
    for (int sweep = 0; sweep < sweeps; ++sweep) {
      system.monitor().check_cancelled();
      gauss_seidel(k, r, e);
      report.residuals.push_back(relative((r - k * e).norm()));
    }
    for (std::size_t i = 0; i < points.size(); ++i)
      for (std::size_t a = 0; a < 3; ++a)
        x[3 * std::size_t(points[i]) + a] += e(Eigen::Index(i), Eigen::Index(a));
    report.residual = report.residuals.back();
    report.converged = true;  // it does what it promises: so many sweeps
    reports.push_back(report);
  }
}

}  // namespace fairing
