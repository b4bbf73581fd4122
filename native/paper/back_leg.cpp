// SPDX-License-Identifier: GPL-3.0-or-later
#include "paper/back_leg.h"

#include <cmath>
#include <utility>

#include "parallel/cancel.h"

namespace fairing {
namespace {

// Gauss-Seidel sweeps on K e = r. Auxiliary unknowns of K are updated at once.
class Sweeps {
 public:
  Sweeps(AssembledSystem system, const Array<double>& residual)
      : system_(std::move(system)),
        diagonal_(system_.diagonal()),
        e_(Points::Zero(system_.matrix.cols(), 3)),
        residual_(residual),
        held_(matrix_bytes(system_.matrix) + std::size_t(e_.size()) * sizeof(double)) {}

  void sweep() {
    for (Eigen::Index i = 0; i < diagonal_.size(); ++i) {
      stop_if_cancelled(std::size_t(i));
      if (!(diagonal_[i] > 0)) continue;
      const Eigen::RowVector3d by = residual_at(i) / diagonal_[i];
      e_.row(i) += by;
      for (Column entry(system_.matrix, i); entry; ++entry)
        if (entry.row() >= diagonal_.size()) e_.row(entry.row()) += entry.value() * by;
    }
  }

  double norm() const {
    double sum = 0;
    for (Eigen::Index i = 0; i < diagonal_.size(); ++i) sum += residual_at(i).squaredNorm();
    return std::sqrt(sum);
  }

  void add_to(Array<double>& x) const {
    for (Eigen::Index i = 0; i < diagonal_.size(); ++i)
      Eigen::Map<Eigen::RowVector3d>(x.data() + 3 * point(i)) += e_.row(i);
  }

 private:
  using Points = Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>;
  using Column = SparseMatrix::InnerIterator;

  std::size_t point(Eigen::Index i) const { return std::size_t(system_.unknown_points[i]); }
  // Of r - K e; K is symmetric.
  Eigen::RowVector3d residual_at(Eigen::Index i) const {
    Eigen::RowVector3d out = Eigen::Map<const Eigen::RowVector3d>(residual_.data() + 3 * point(i));
    for (Column entry(system_.matrix, i); entry; ++entry)
      out -= entry.value() * e_.row(entry.row());
    return out;
  }

  const AssembledSystem system_;
  const Eigen::VectorXd diagonal_;
  Points e_;
  const Array<double>& residual_;
  const CountedBytes held_;
};

}  // namespace

void solve_back_leg(ThinPlateLevels& levels, const PlateData& data, int sweeps,
                    const Monitor& monitor, Array<double>& x, std::vector<LevelReport>& reports,
                    const std::function<void(const double*)>& on_prediction) {
  for (int level = levels.base(); level <= levels.top(); ++level) {
    const std::size_t size = 3 * levels.grid(level).size();
    const Array<double> below = std::exchange(x, Array<double>(size));
    levels.start(level, data, below, x);
    if (level == levels.top() && on_prediction) on_prediction(x.data());
    Array<double> residual(size), polyhedron(size);
    const double reference =
        levels.scales(level, data, {}, polyhedron.data(), residual.data()).residual;
    levels.residual(level, data.targets, {}, x.data(), residual.data());
    Sweeps gauss_seidel(levels.op(level).assemble(), residual);
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
    gauss_seidel.add_to(x);
    report.residual = report.residuals.back();
    report.converged = true;  // the given number of sweeps is all that it promises
    reports.push_back(report);
  }
}

}  // namespace fairing
