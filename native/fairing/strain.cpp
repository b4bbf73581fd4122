// SPDX-License-Identifier: GPL-3.0-or-later
#include "fairing/strain.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <new>

#include "fairing/fair.h"
#include "fairing/mending.h"
#include "parallel/cancel.h"
#include "strain/border_moments.h"

namespace fairing {
FairOptions options_of_strain(const FairOptions& given) {
  if (given.energy == Energy::minimum_variation)
    throw FairingError(ErrorCode::bad_option,
                       "energy=\"minimum_variation\" has no strain: its control vertices stand on "
                       "no pads, so no loads tell of them. Use energy=\"thin_plate\".");
  if (given.energy != Energy::thin_plate)
    throw FairingError(ErrorCode::bad_option,
                       "Strain is that of the thin plate. Use energy=\"thin_plate\".");
  if (given.interpolation != Interpolation::exact)
    throw FairingError(ErrorCode::bad_option,
                       "Strain asks how control vertices that stay fight the surface. Use "
                       "interpolation=\"exact\".");
  if (!(given.width_of_pads() > 0))
    throw FairingError(ErrorCode::bad_option,
                       "Strain is read off the loads on pads, and there are none: use a pad_size "
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
  Array<double> surface;
  PlateState state = systems.solve(control, false, watch, report, surface);
  PlateLoads out{state.loads, {}};
  ThinPlateSolver& plate = systems.plate();
  if (plate.pads()) {
    const std::vector<double> moments = border_moments(
        systems.finest(), *problem.charts(), *plate.pads(), problem.unknowns, control.working);
    const CountedBytes counted(moments.size() * sizeof(double));
    if (!moments.empty())
      plate.solve_again(PlateData{control.working, control.working_curves},
                        problem.options.solve.relative_residual, state, surface, 0, moments);
  }
  out.turned = std::move(state.loads);
  return out;
}

namespace {

// Between two vertices of one solve: 36 sets, and so 12 solves, on quads. G falls by some 2.6 a ring.
constexpr int rings_apart = 6;

Strain strain_of(const Mending& mending, Monitor& monitor) {
  Report report;
  Stopwatch watch(report, monitor);
  const std::unique_ptr<const FairingProblem> problem =
      make_problem(mending.mesh(), mending.options(), watch, report);
  StrainGauge::require_room(*problem, rings_apart);
  FairingSystems systems(*problem, monitor);
  const PlateLoads loads = solve_loads(*problem, systems, problem->basis, watch);
  const StrainGauge gauge(*problem, systems.plate(), rings_apart);
  Strain out{gauge.strain(loads.free, problem->basis), gauge.excess(loads.turned, problem->basis),
             std::vector<std::uint8_t>(std::size_t(problem->mesh.input_vertices), 0)};
  for (std::size_t i = gauge.on_pads(); i < gauge.vertices().size(); ++i)
    out.on_curve[std::size_t(gauge.vertices()[i])] = 1;
  return out;
}

}  // namespace

Strain measure_strain(const PolygonMesh& input, const FairOptions& options, Monitor& monitor) {
  const CancelScope scope(&monitor);
  try {
    const FairOptions own = options_of_strain(options);
    const Mending mending(input, own);
    Strain out = mending.in_input_ids([&] { return strain_of(mending, monitor); });
    if (mending.mended()) {
      const std::vector<Index>& origin = mending.mended()->vertex_origin;
      restore(out.all, origin);
      restore(out.excess.own, origin);
      for (std::size_t v = 0; v < std::min(origin.size(), out.on_curve.size()); ++v)
        out.on_curve[v] = out.on_curve[std::size_t(origin[v])];
    }
    monitor.report(Phase::done, 1);
    return out;
  } catch (const std::bad_alloc&) {
    throw out_of_memory();
  }
}

}  // namespace fairing
