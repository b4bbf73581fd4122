// SPDX-License-Identifier: GPL-3.0-or-later
// What a run has to say besides the surface. binding/report.cpp makes dicts of these structs, field
// by field in the same order; docs/python/fair.md describes them to callers.
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

// Of one surface on the finest level. NaN where it was not to be measured.
struct SurfaceEnergies {
  // In the control metric; mesh units^(2 - 2 exponent).
  double thin_plate = 0;
  // The integral of k1^2 + k2^2 over the surface; a pure number.
  double total_curvature = 0;
};

// Of one further shape, on the finest level.
struct ShapeReport {
  LevelReport finest;
  bool converged = false;  // as Report::converged()
  double largest_deviation = 0;
  int constraint_rounds = 0;
  double normal_angle = 0;  // degrees
};

// Fixed normals: of how many input vertices, and the largest angle that is left; degrees.
struct NormalReport {
  std::size_t fixed = 0;
  double largest_angle = 0;
};

// The pads under the input vertices: how many are gone, and each one's width, 0 where there is none.
// Empty without pads.
struct PadReport {
  std::size_t gone = 0;
  std::vector<double> widths;
};

// How many sheets the input is made of (mesh/sheets.h), how many edges have more than two faces, and
// at how many other vertices sheets touch; and how many sheets have only one side.
struct SheetReport {
  std::size_t count = 0, nonmanifold_edges = 0, nonmanifold_vertices = 0, one_sided = 0;
};

struct PhaseSeconds {
  std::string phase;
  double seconds;
};

struct Report {
  // Of the surface, of the control polyhedron, and of the start on the finest level.
  SurfaceEnergies result, polyhedron, prediction;
  // Linear solves, coarse to fine.
  std::vector<LevelReport> levels;
  // Gauss-Newton steps, coarse to fine; empty for the thin plate.
  std::vector<CurvatureLevelReport> curvature;
  // Started from an earlier surface.
  bool warm = false;
  std::vector<ShapeReport> shapes;
  std::vector<PhaseSeconds> seconds;
  // Of the run's own long arrays and factors.
  std::size_t predicted_bytes = 0, peak_bytes = 0;
  // Of an input vertex from where it was given, in mesh units.
  double largest_deviation = 0;
  // Solves that tolerance or epsilon took.
  int constraint_rounds = 0;
  // Tolerance: how far the energy may be over the least possible one, relative.
  double constraint_gap = 0;
  PadReport pads;
  NormalReport normals;
  SheetReport sheets;
  int threads = 1;
  std::vector<Warning> warnings;
  // What Repair::mend has done, each with all elements of the input concerned.
  std::vector<Warning> repairs;
  // Input faces that were reversed by Repair::mend.
  std::vector<std::int64_t> flipped_faces;

  // Whether the surface is as near to the solution as was promised; one that is not has a warning
  // (warnings.h). What became of coarser levels, and of the thin plate that steps start from, is
  // theirs alone. Needs a level.
  bool converged() const {
    return curvature.empty() ? levels.back().converged : curvature.back().converged;
  }
};

// Writes the seconds of each phase into a report, a phase that comes again added to the first, and
// tells the monitor where the run is. enter() throws FairingError(cancelled) where that was asked.
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
