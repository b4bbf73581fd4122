// SPDX-License-Identifier: GPL-3.0-or-later
// The solve of one level with constraints (constraints/held_solve.h).
#include <algorithm>
#include <cmath>

#include "constraints/held_solve.h"
#include "thin_plate/run.h"

namespace fairing {
namespace {

// A more accurate surface requires more accurate loads.
double force_tolerance(double relative_residual) {
  return std::min(10 * std::sqrt(relative_residual), largest_force_left);
}

bool has_free_border(const ControlMesh& mesh, const Unknowns& unknowns) {
  for (std::size_t e = 0; e < mesh.edges.size(); ++e)
    if (mesh.edges[e].boundary() && unknowns.edge[e]) return true;
  return false;
}

// Whether a point force under the penalty moves less of the surface than its pad covers: on a
// foundation of P per area a plate of unit stiffness holds against it with 8 sqrt(P) [Timoshenko,
// Woinowsky-Krieger 1959, 57], the foundation under the pad with more.
bool is_narrower_than_pads(const Hats& hats, const Array<float>& penalty) {
  const NormalLoads sums = hats.gather(Array<double>(penalty.begin(), penalty.end()));
  for (std::size_t v = 0; v < sums.size(); ++v)
    if (hats.under(v) && sums[v][0] > 8 * std::sqrt(sums[v][0] / hats.total(v))) return true;
  return false;
}

}  // namespace

HeldLimits ThinPlateSolver::Run::held_limits(int level, const PcgLimits& limits) const {
  const bool is_top = level == top();
  HeldLimits out;
  out.solve = limits;
  out.ends_whole = is_top;
  out.force =
      std::max(rough_force, is_top ? force_tolerance(solver.options_.solve.relative_residual)
                                   : coarse_force_tolerance);
  out.angle = largest_angle_left / largest_force_left * out.force;
  out.gap = is_top ? gap_wanted : coarse_gap;
  return out;
}

ThinPlateSolver::Run::Solved ThinPlateSolver::Run::solve(int level, const PcgLimits& limits,
                                                         BallConstraints* constraints) {
  PlateSupports& supports = solver.supports_;
  Workers& workers = levels().workers();
  const Unknowns& unknowns = levels().shared().unknowns;
  const std::shared_ptr<const Hats> hats = supports.hats(level);
  const std::shared_ptr<const LevelCouples> couples = supports.couples(level);
  const auto residual = [&](const double* y, double* out) {
    levels().apply_with(level, hats ? hats->rows() : unknowns, y, out);
    for_each_index(workers, size(level), [&](std::size_t i) { out[i] = -out[i]; });
    levels().add_penalty(level, reference, out);
    if (level == top())
      for (std::size_t i = 0; i < data.forces.size(); ++i) out[i] += data.forces[i];
  };
  int iterations = 0;
  const auto solve_level = [&](const PcgLimits& now, LinearSystem system) {
    system.watch = [&](const PcgResult& so_far) {  // the number of iterations is unknown
      report_done(level, 1 - 1 / std::sqrt(1.0 + iterations + so_far.iterations));
    };
    LevelSolve solved = levels().solve(level, now, system);
    iterations += solved.iterations;
    return solved;
  };
  using Restriction = decltype(HeldSystem<3>::restrict_to_vertices);
  const Restriction restrict_to_vertices = [&](std::span<const double> y, std::span<Vec3> sums) {
    levels().restrict_to_vertices(level, y.data(), sums);
  };
  // Rows at a free border may be arbitrarily stiff, and H with them; under a strong penalty H is narrow.
  // Then the prolongation does not approximate H (docs/developers/notes/performance.md), and the
  // vertices' own rows are used.
  const bool reads_own_rows =
      has_free_border(levels().shared().mesh, unknowns) ||
      (!reference.empty() && hats && is_narrower_than_pads(*hats, levels().penalty(level)));
  const HeldSystem<3> system{
      .workers = workers,
      .size = size(level),
      .unknowns = unknowns,
      .weights = levels().weights(level),
      .stiffness = supports.stiffness(),
      .hats = hats.get(),
      .couples = couples.get(),
      .target =
          [&](std::size_t v) {
            return (constraints ? constraints->shifted_targets() : data.targets)[v];
          },
      .residual = residual,
      .solve = solve_level,
      .restrict_to_vertices = reads_own_rows ? Restriction{} : restrict_to_vertices,
      .set_weights = [&](const VertexWeights& weights) { levels().set_weights(weights, level); },
      .energy = [&](const double* y) { return levels().energy(level, y); },
      .compliance_of_couples = [&]() -> const Compliance& {
        return supports.compliance(level, solver.options_.solve.max_iterations);
      }};
  const HeldLimits held = held_limits(level, limits);
  LevelReport report = report_of(level);
  report.constraint_rounds = constraints != nullptr;
  HeldSolve<3> solve(system, held, constraints, state, report);
  static_cast<LevelSolve&>(report) = solve.run(x.data(), r.data());
  report.converged &= solve.loads_settled();
  if (constraints) {
    constraints->enforce(x.data());
    report.converged &= report.constraint_gap <= held.gap;
  }
  // Couples hold the tangent plane; the surface may still have the opposite normal.
  if (couples && level == top()) report.converged &= report.normal_angle <= largest_angle_left;
  LevelSolve equivalent = report;
  if (solve.gain() > 0 && (hats || constraints || couples))
    equivalent.iterations = int(-report.iterations * std::log(limits.tolerance) / solve.gain());
  return {report, equivalent};
}

}  // namespace fairing
