// SPDX-License-Identifier: GPL-3.0-or-later
#include "strain/strain.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "fairing/fair.h"
#include "fairing/mending.h"
#include "parallel/cancel.h"
#include "strain/border_moments.h"

namespace fairing {
FairOptions options_of_strain(const FairOptions& given) {
  if (given.energy == Energy::minimum_variation)
    throw FairingError(ErrorCode::bad_option,
                       {"energy=\"minimum_variation\" has no strain: its control vertices have "
                        "no pads.",
                        "Use energy=\"thin_plate\"."});
  if (given.energy != Energy::thin_plate)
    throw FairingError(ErrorCode::bad_option,
                       {"Strain is that of the thin plate.", "Use energy=\"thin_plate\"."});
  if (given.interpolation != Interpolation::exact)
    throw FairingError(ErrorCode::bad_option, {"Strain needs control vertices that stay.",
                                               "Use interpolation=\"exact\"."});
  if (!(given.width_of_pads() > 0))
    throw FairingError(
        ErrorCode::bad_option,
        "Strain is computed from the loads on pads, and there are none: use a pad_size "
        "over 0, no epsilon, and multigrid.");
  FairOptions options = given;
  options.levels = std::clamp(given.levels, 1, Couples::first_level);
  options.shapes = {};
  options.measure = false;
  return options;
}

PlateLoads solve_loads(const FairingProblem& problem, FairingSystems& systems,
                       const ControlPositions& control, Stopwatch& watch) {
  Report report;
  Surface surface = systems.solve(control, false, watch, report);
  PlateLoads out{surface.state.loads, {}};
  if (const Pads* const pads = systems.plate().pads()) {
    const std::vector<double> moments = border_moments(systems.finest(), *problem.charts(), *pads,
                                                       problem.unknowns, control.working);
    const CountedBytes counted(moments.size() * sizeof(double));
    if (!moments.empty()) systems.solve_under(moments, control, surface);
  }
  out.turned = std::move(surface.state.loads);
  return out;
}

namespace {

// Distance of two vertices in one solve: 36 sets, 12 solves, on quads. G falls by 2.6 a ring.
constexpr int rings_apart = 6;

// Largest remainder next to a gross error after its release, as a share of the error: 0.072 on
// terrains of 676 and 1,681 vertices with one vertex 100 m off. It comes from bent charts and the
// truncated matrix of loads.
constexpr double echo = 0.08;

Strain strain_once(const PolygonMesh& mesh, const FairOptions& options, Monitor& monitor) {
  Report report;
  Stopwatch watch(report, monitor);
  const std::unique_ptr<const FairingProblem> problem = make_problem(mesh, options, watch, report);
  StrainGauge::require_room(*problem, rings_apart, report.predicted_bytes);
  FairingSystems systems(*problem, monitor);
  const PlateLoads loads = solve_loads(*problem, systems, problem->basis, watch);
  const StrainGauge gauge(*problem, systems, rings_apart);
  Strain out{gauge.strain(loads.free, problem->basis), gauge.excess(loads.turned, problem->basis),
             std::vector<std::uint8_t>(std::size_t(problem->mesh.input_vertices), 0)};
  for (std::size_t i = gauge.on_pads(); i < gauge.vertices().size(); ++i)
    out.on_curve[gauge.vertices()[i]] = 1;
  return out;
}

double largest_wrong(const Excess& excess) {
  double largest = 0;
  for (std::size_t v = 0; v < excess.wrong.size(); ++v)
    if (excess.wrong[v]) largest = std::max(largest, std::abs(excess.own.lengths[v]));
  return largest;
}

// Corrects gross errors and measures again, as long as their number falls below half.
Strain strain_of(const Mending& mending, Monitor& monitor) {
  PolygonMesh mesh = mending.mesh();
  std::vector<double> at(mesh.coordinates.begin(), mesh.coordinates.end());
  mesh.coordinates = at;
  double left = 0.25;  // share of the progress
  monitor.enter_part(0, 1 - left);
  Strain out = strain_once(mesh, mending.options(), monitor);
  Excess& excess = out.excess;
  std::vector<Vec3> ways(excess.wrong.size(), Vec3::Zero());
  std::vector<double> lengths(ways.size(), 0);
  std::vector<std::uint8_t> wrong(ways.size(), 0);
  double largest = largest_wrong(excess);
  const double least = mending.options().solve.relative_residual * largest;
  while (largest > least && largest * echo > excess.floor) {
    for (std::size_t v = 0; v < ways.size(); ++v) {
      if (!excess.wrong[v] || std::abs(excess.own.lengths[v]) < largest * echo) continue;
      wrong[v] = 1;
      ways[v] += excess.own.ways[v];
      lengths[v] += excess.own.lengths[v];
      for (std::size_t a = 0; a < 3; ++a) at[3 * v + a] += excess.own.ways[v][a];
    }
    monitor.enter_part(1 - left, 1 - left / 2);
    left /= 2;
    excess = strain_once(mesh, mending.options(), monitor).excess;
    const double before = std::exchange(largest, largest_wrong(excess));
    if (largest > before / 2) break;
  }
  for (std::size_t v = 0; v < ways.size(); ++v) {
    excess.own.ways[v] += ways[v];
    excess.own.lengths[v] += lengths[v];
    excess.wrong[v] |= wrong[v];
  }
  monitor.enter_part(0, 1);
  return out;
}

}  // namespace

Strain measure_strain(const PolygonMesh& input, const FairOptions& options, Monitor& monitor) {
  const CancelScope scope(&monitor);
  return with_named_errors([&] {
    const FairOptions own = options_of_strain(options);
    const MemoryLedger ledger(own.bytes_allowed());
    const Mending mending(input, own);
    Strain out = mending.in_input_ids([&] { return strain_of(mending, monitor); });
    if (mending.mended()) {
      const std::vector<Index>& origin = mending.mended()->vertex_origin;
      restore(out.all, origin);
      restore(out.excess, origin);
      give_to_merged(origin, out.on_curve);
    }
    monitor.report(Phase::done, 1);
    return out;
  });
}

}  // namespace fairing
