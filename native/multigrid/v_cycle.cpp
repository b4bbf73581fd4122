// SPDX-License-Identifier: GPL-3.0-or-later
#include "multigrid/v_cycle.h"

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "base/error.h"
#include "parallel/reductions.h"

namespace fairing {

struct CoarseSolver::Factor {
  std::vector<Index> points;
  // Analyzed once: Eigen's vectors free memory twice if a second size cannot be allocated.
  std::optional<Eigen::SimplicialLDLT<SparseMatrix>> ldlt{std::in_place};
  // The pattern of the elimination's order: columns, and rows one column after another.
  std::vector<int> columns, rows;

  // Computes the order again if the pattern has changed.
  void compute(const SparseMatrix& k) {
    const auto same = [](const std::vector<int>& known, const int* now, Eigen::Index count) {
      return std::equal(known.begin(), known.end(), now, now + count);
    };
    if (!same(columns, k.outerIndexPtr(), k.outerSize() + 1) ||
        !same(rows, k.innerIndexPtr(), k.nonZeros())) {
      columns.clear();
      ldlt.emplace().analyzePattern(k);
      rows.assign(k.innerIndexPtr(), k.innerIndexPtr() + k.nonZeros());
      columns.assign(k.outerIndexPtr(), k.outerIndexPtr() + k.outerSize() + 1);
    }
    ldlt->factorize(k);
  }
};

namespace {

// A trace added to the diagonal, relative to it. A vertex of valence three does not determine some
// coarse waves; a trace well above rounding keeps the factor definite, and the preconditioner as
// good. Large rings need it too. (More of it there makes the steps worse: thin faces make K
// ill-conditioned.)
constexpr double trace = 1e-12;

// x <- (L D L^T)^-1 x for C right-hand sides together: every number of the factor is read once.
template <int C, class Ldlt>
void substitute(const Ldlt& ldlt, double* x) {
  const SparseMatrix& l = ldlt.matrixL().nestedExpression();  // without its unit diagonal
  const int *const begin = l.outerIndexPtr(), *const row = l.innerIndexPtr();
  const double* const number = l.valuePtr();
  const auto diagonal = ldlt.vectorD();  // copied each time
  double sum[C];
  for (int c = 0; c < l.cols(); ++c) {
    std::copy_n(x + C * c, C, sum);
    for (int k = begin[c]; k < begin[c + 1]; ++k)
      for (int a = 0; a < C; ++a) x[C * row[k] + a] -= sum[a] * number[k];
  }
  for (int c = int(l.cols()) - 1; c >= 0; --c) {
    const double inverse = 1 / diagonal(c);
    for (int a = 0; a < C; ++a) sum[a] = inverse * x[C * c + a];
    for (int k = begin[c]; k < begin[c + 1]; ++k)
      for (int a = 0; a < C; ++a) sum[a] -= number[k] * x[C * row[k] + a];
    std::copy_n(sum, C, x + C * c);
  }
}

void strengthen_diagonal(AssembledSystem& system) {
  const Eigen::VectorXd diagonal = system.diagonal();
  for (Eigen::Index i = 0; i < diagonal.size(); ++i)
    system.matrix.coeffRef(i, i) += trace * diagonal(i);
}

}  // namespace

CoarseSolver::CoarseSolver(LevelOperator& op, Workers& workers, std::size_t unknowns,
                           bool always_direct)
    : op_(op), workers_(workers) {
  if (unknowns > direct_limit && !always_direct) return;
  factor_ = std::make_unique<Factor>();
  refactor();
}

void CoarseSolver::refactor() {
  if (!factors())
    throw FairingError(
        ErrorCode::underdetermined,
        {"The surface is not determined: a part of the mesh has too few fixed points.",
         "Interpolate more control vertices, or give them weights."});
  factored_ = op_.version().numbers;
}

bool CoarseSolver::factors() {
  AssembledSystem system = op_.assemble();
  strengthen_diagonal(system);
  factor_->points = std::move(system.unknown_points);
  if (factor_->points.empty()) return true;
  // the new factor takes the place of the last one
  MemoryLedger::remove(std::exchange(factor_bytes_, 0));
  const SparseMatrix lower = system.matrix.triangularView<Eigen::Lower>();
  SparseMatrix().swap(system.matrix);  // assignment would keep the memory
  // The matrix, its permuted copy, and its pattern.
  const CountedBytes held(2 * matrix_bytes(lower) + matrix_bytes(lower) / 3);
  factor_->compute(lower);
  // If a pivot is not finite, the steps reject the result.
  if (factor_->ldlt->info() != Eigen::Success ||
      (factor_->ldlt->vectorD().array() <= 0).count() > system.negative)
    return false;
  factor_bytes_ =
      std::size_t(factor_->ldlt->matrixL().nestedExpression().nonZeros()) * matrix_entry;
  MemoryLedger::add(factor_bytes_);
  return true;
}

CoarseSolver::~CoarseSolver() { MemoryLedger::remove(factor_bytes_); }

void CoarseSolver::solve(const double* b, double* x) const {
  std::fill(x, x + op_.size(), 0.0);
  const auto& points = factor_->points;
  if (points.empty()) return;
  const std::size_t components = op_.components();
  const int* const place = factor_->ldlt->permutationP().indices().data();
  std::vector<double> y(components * std::size_t(factor_->ldlt->rows()), 0.0);
  const auto visit = [&](auto&& copy) {
    for (std::size_t i = 0; i < points.size(); ++i)
      for (std::size_t a = 0; a < components; ++a)
        copy(components * std::size_t(points[i]) + a, components * std::size_t(place[i]) + a);
  };
  visit([&](std::size_t of_level, std::size_t of_factor) { y[of_factor] = b[of_level]; });
  components == 3 ? substitute<3>(*factor_->ldlt, y.data())
                  : substitute<1>(*factor_->ldlt, y.data());
  visit([&](std::size_t of_level, std::size_t of_factor) { x[of_level] = y[of_factor]; });
}

double CoarseSolver::norm_of_terms(const double* x) const {
  const Array<float>& inverse = op_.inverse_diagonal();
  const std::size_t components = op_.components();
  return std::sqrt(sum(workers_, op_.size(), [&](std::size_t i) {
    const double over = inverse[i / components];
    return over > 0 ? x[i] * x[i] / (over * over) : 0.0;
  }));
}

void CoarseSolver::solve(const LineJacobi* lines, double largest_eigenvalue, int degree,
                         SmootherState& state) {
  if (!factor_) {
    // As much as on other levels: more smoothing saves no iteration, and small faces are expensive.
    smooth(op_, lines, workers_, largest_eigenvalue, degree, SmoothFrom::zero, false, state);
    return;
  }
  const std::size_t size = op_.size();
  const std::vector<double> b(state.residual.begin(), state.residual.begin() + size);
  std::vector<double> x(size);
  solve(b.data(), x.data());
  std::copy(x.begin(), x.end(), state.x.begin());
}

void VCycle::run(std::size_t top, int before, int after) {
  CycleLevel& level = levels[top];
  if (top == base) {
    coarse->solve(level.lines.get(), level.largest_eigenvalue, degree, level.state);
    return;
  }
  SmootherState& s = level.state;
  const auto smooth_from = [&](SmoothFrom from, int steps, bool last_residual) {
    smooth(*level.op, level.lines.get(), workers_, level.largest_eigenvalue, steps, from,
           last_residual, s);
  };
  smooth_from(SmoothFrom::zero, before, true);
  level.transfer->restrict_to(s.residual.data(), levels[top - 1].state.residual.data());
  run(top - 1, before, after);
  level.transfer->prolong(levels[top - 1].state.x.data(), s.step.data());
  smooth_from(SmoothFrom::correction, after, false);
}

}  // namespace fairing
