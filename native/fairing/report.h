// SPDX-License-Identifier: GPL-3.0-or-later
// The results of a run other than the surface. binding/report.cpp converts these structs to dicts,
// field by field in the same order; docs/python/report.md describes them.
#pragma once

#include <chrono>
#include <cstddef>
#include <string>
#include <vector>

#include "base/error.h"
#include "curvature/options.h"
#include "parallel/monitor.h"
#include "thin_plate/options.h"

namespace fairing {

// Of one surface on the finest level. NaN: not measured.
struct SurfaceEnergies {
  // In the control metric; mesh units^(2 - 2 exponent).
  double thin_plate = 0;
  // The integral of k1^2 + k2^2 over the surface; a pure number.
  double total_curvature = 0;
};

// For one further shape, on the finest level.
struct ShapeReport {
  LevelReport finest;
  bool converged = false;  // as Report::converged()
  double largest_deviation = 0;
  int constraint_rounds = 0;
  double normal_angle = 0;  // degrees
};

// Fixed normals: their number, and the largest remaining angle in degrees.
struct NormalReport {
  std::size_t fixed = 0;
  double largest_angle = 0;
};

// Pads of the input vertices: how many are left out, and the width of each, 0 for none. Empty
// without pads.
struct PadReport {
  std::size_t gone = 0;
  std::vector<double> widths;
};

// The number of sheets (mesh/sheets.h), of edges with more than two faces, of other vertices where
// sheets touch, and of sheets with one side.
struct SheetReport {
  std::size_t count = 0, nonmanifold_edges = 0, nonmanifold_vertices = 0, one_sided = 0;
};

struct PhaseSeconds {
  std::string phase;
  double seconds;
};

struct Report {
  // Energies of the surface, of the control polyhedron, and of the start on the finest level.
  SurfaceEnergies result, polyhedron, prediction;
  // Linear solves, coarse to fine.
  std::vector<LevelReport> levels;
  // Gauss-Newton steps, coarse to fine; empty for the thin plate.
  std::vector<CurvatureLevelReport> curvature;
  // Whether an earlier surface was used.
  bool warm = false;
  std::vector<ShapeReport> shapes;
  std::vector<PhaseSeconds> seconds;
  // Bytes of the run's own long arrays and factors.
  std::size_t predicted_bytes = 0, peak_bytes = 0;
  // Largest distance of an input vertex from its given position, in mesh units.
  double largest_deviation = 0;
  // Corrections made for a tolerance or epsilon.
  int constraint_rounds = 0;
  // With a tolerance: bound on how far the energy is above the minimum, relative.
  double constraint_gap = 0;
  PadReport pads;
  NormalReport normals;
  SheetReport sheets;
  int threads = 1;
  std::vector<Warning> warnings;
  // Repairs by Repair::mend, each with all input elements concerned.
  std::vector<Warning> repairs;
  // Input faces that were reversed by Repair::mend.
  std::vector<std::int64_t> flipped_faces;

  // Whether the surface is as near to the solution as promised; otherwise there is a warning
  // (warnings.h). Coarser levels, and the thin plate that steps start from, do not count. Needs a
  // level.
  bool converged() const {
    return curvature.empty() ? levels.back().converged : curvature.back().converged;
  }
};

// Adds the seconds of each phase to a report and shows the phase in the monitor. enter() throws
// FairingError(cancelled) if that was requested.
class Stopwatch {
 public:
  Stopwatch(Report& report, Monitor& monitor) : report_(report), monitor_(monitor) {}

  void enter(Phase phase, double fraction) {
    leave();
    phase_ = phase;
    monitor_.report(phase, fraction);
  }
  void leave() {
    const auto now = std::chrono::steady_clock::now();
    if (running_) add(name(phase_), std::chrono::duration<double>(now - start_).count());
    start_ = now;
    running_ = true;
  }

 private:
  void add(const char* phase, double seconds) {
    for (auto& entry : report_.seconds)
      if (entry.phase == phase) {
        entry.seconds += seconds;
        return;
      }
    report_.seconds.push_back({phase, seconds});
  }

  Report& report_;
  Monitor& monitor_;
  Phase phase_ = Phase::check;
  bool running_ = false;
  std::chrono::steady_clock::time_point start_;
};

}  // namespace fairing
