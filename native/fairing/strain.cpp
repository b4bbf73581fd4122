// SPDX-License-Identifier: GPL-3.0-or-later
#include "fairing/strain.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <new>

#include "fairing/fair.h"
#include "fairing/mending.h"
#include "fairing/systems.h"
#include "parallel/cancel.h"
#include "strain/own_loads.h"

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
  options.levels = std::clamp(given.levels, 1, level_of_first_loads);
  options.shapes = {};
  options.measure = false;
  return options;
}

namespace {

Strain strain_of(const Mending& mending, Monitor& monitor) {
  Report report;
  Stopwatch watch(report, monitor);
  const std::unique_ptr<const FairingProblem> problem =
      make_problem(mending.mesh(), mending.options(), watch, report);
  FairingSystems systems(*problem, monitor);
  ThinPlateSolver& solver = systems.plate();
  Array<double> surface;
  const Loads loads = systems.solve(problem->basis, false, watch, report, surface).loads;
  const StrainGauge gauge(*problem, own_loads(solver, problem->basis.working_curves));
  return gauge.read(loads, problem->basis.working);
}

}  // namespace

Strain measure_strain(const PolygonMesh& input, const FairOptions& options, Monitor& monitor) {
  const CancelScope scope(&monitor);
  try {
    const FairOptions own = options_of_strain(options);
    const Mending mending(input, own);
    Strain out = mending.in_input_ids([&] { return strain_of(mending, monitor); });
    if (mending.mended()) out.restore(mending.mended()->vertex_origin);
    monitor.report(Phase::done, 1);
    return out;
  } catch (const std::bad_alloc&) {
    throw out_of_memory();
  }
}

}  // namespace fairing
