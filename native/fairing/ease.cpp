// SPDX-License-Identifier: GPL-3.0-or-later
#include "fairing/ease.h"

#include <algorithm>
#include <limits>
#include <new>

#include "fairing/fair.h"
#include "fairing/mending.h"
#include "fairing/strain.h"
#include "fairing/systems.h"
#include "parallel/cancel.h"
#include "strain/ease.h"
#include "strain/own_loads.h"

namespace fairing {
namespace {

constexpr double solve_tolerance = 1e-3;  // as that of own_loads()
// With more input vertices the loads are those of level 1, at a quarter of the cost.
constexpr std::int64_t on_second_level = 2000;

// The loads that moves of some control vertices alone ask for, while it exists.
class Moved {
 public:
  Moved(ThinPlateSolver& solver, const FeatureCurves& curves, std::vector<Index> free)
      : solver_(solver),
        mesh_(solver.levels().shared().mesh),
        none_(curves),
        free_(std::move(free)),
        targets_(std::size_t(mesh_.vertex_count())),
        x_(3 * solver.levels().grid(solver.levels().top()).size()) {
    for (Vec3& p : none_.points) p.setZero();
    solver_.keep_smoother();
  }

  Columns operator()(const Columns& moves) {
    std::fill(targets_.begin(), targets_.end(), Vec3::Zero());
    std::fill(x_.begin(), x_.end(), 0.0);
    for (std::size_t i = 0; i < free_.size(); ++i)
      mesh_.for_each_copy(free_[i], [&](Index u) {
        targets_[std::size_t(u)] = moves.row(Eigen::Index(i)).transpose();
      });
    PlateState state = solver_.unheld();
    state.loads.assign(targets_.size(), Vec3::Zero());
    solver_.solve_again({targets_, none_}, solve_tolerance, state, x_);
    return rows_of(state.loads);
  }

 private:
  Columns rows_of(const Loads& loads) const {
    Columns out(Eigen::Index(free_.size()), 3);
    for (std::size_t i = 0; i < free_.size(); ++i)
      out.row(Eigen::Index(i)) = loads[std::size_t(free_[i])].transpose();
    return out;
  }

  ThinPlateSolver& solver_;
  const ControlMesh& mesh_;
  FeatureCurves none_;
  std::vector<Index> free_;
  std::vector<Vec3> targets_;
  Array<double> x_;
};

EaseResult eased(const Mending& mending, const EaseOptions& wanted, Monitor& monitor) {
  Report report;
  Stopwatch watch(report, monitor);
  const std::unique_ptr<const FairingProblem> problem =
      make_problem(mending.mesh(), mending.options(), watch, report);
  FairingSystems systems(*problem, monitor);
  ThinPlateSolver& solver = systems.plate();
  const ControlMesh& mesh = problem->mesh;
  const FeatureCurves& curves = problem->basis.working_curves;
  const auto n = std::size_t(mesh.input_vertices);
  const double unit = problem->frame.scale;
  EaseResult out;
  out.moves.assign(n, Vec3::Zero());
  out.strain_before.assign(n, std::numeric_limits<double>::quiet_NaN());
  out.strain_after = out.strain_before;
  Array<double> surface;
  const Loads loads = systems.solve(problem->basis, false, watch, report, surface).loads;
  if (!solver.pads()) return out;
  const std::vector<double> own = own_loads(solver, curves);

  std::vector<Index> held, free;
  for (std::size_t v = 0; v < n; ++v) {
    if (!solver.pads()->under(v) || !(own[v] > 0)) continue;
    held.push_back(Index(v));
    if (wanted.fixed.empty() || !wanted.fixed[v]) free.push_back(Index(v));
  }
  const auto rows = Eigen::Index(free.size());
  Columns free_loads(rows, 3);
  Eigen::VectorXd free_own(rows), bounds(wanted.tolerance.empty() ? 0 : rows);
  for (Eigen::Index i = 0; i < rows; ++i) {
    const auto v = std::size_t(free[std::size_t(i)]);
    free_loads.row(i) = loads[v].transpose();
    free_own[i] = own[v];
    // less rounding, so that what is measured outside is within it
    if (bounds.size() > 0) bounds[i] = (1 - 1e-12) * wanted.tolerance[v] / unit;
  }
  Eased found;
  {
    Moved moved(solver, curves, free);
    const LoadsOfMoves loads_of = [&](const Columns& moves) { return moved(moves); };
    found = wanted.most > 0 ? ease_worst(loads_of, free_loads, free_own, wanted.most)
                            : ease(loads_of, free_loads, bounds);
  }
  Columns all_moves = Columns::Zero(Eigen::Index(held.size()), 3);
  for (std::size_t i = 0, f = 0; i < held.size(); ++i)
    if (f < free.size() && free[f] == held[i])
      all_moves.row(Eigen::Index(i)) = found.moves.row(Eigen::Index(f++));
  const Columns change = Moved(solver, curves, held)(all_moves);
  for (std::size_t i = 0; i < held.size(); ++i) {
    const auto v = std::size_t(held[i]);
    out.moves[v] = unit * all_moves.row(Eigen::Index(i)).transpose();
    const Vec3 normal = normal_of(mesh, held[i]);
    const Vec3 after = loads[v] + change.row(Eigen::Index(i)).transpose();
    out.strain_before[v] = -unit / own[v] * loads[v].dot(normal);
    out.strain_after[v] = -unit / own[v] * after.dot(normal);
  }
  out.amount = found.amount;
  out.noise = unit * found.noise;
  out.iterations = found.solves;
  return out;
}

}  // namespace

EaseResult ease_control_mesh(const PolygonMesh& input, const FairOptions& options,
                             const EaseOptions& wanted, Monitor& monitor) {
  const CancelScope scope(&monitor);
  try {
    FairOptions own = options_of_strain(options);
    if (std::int64_t(input.coordinates.size()) > 3 * on_second_level) own.levels = 1;
    const Mending mending(input, own);
    if (mending.mended())
      throw FairingError(ErrorCode::bad_option,
                         "Easing moves the vertices of the mesh as it is, and this one has to be "
                         "mended. Mend it first, and ease what comes out.");
    EaseResult out = mending.in_input_ids([&] { return eased(mending, wanted, monitor); });
    monitor.report(Phase::done, 1);
    return out;
  } catch (const std::bad_alloc&) {
    throw out_of_memory();
  }
}

}  // namespace fairing
