// SPDX-License-Identifier: GPL-3.0-or-later
#include "binding/report.h"

#include <pybind11/stl.h>

namespace py = pybind11;

namespace fairing {
namespace {

py::list to_python(const std::vector<Warning>& warnings) {
  py::list list;
  for (const Warning& w : warnings) {
    py::dict entry;
    entry["code"] = w.code;
    entry["message"] = w.message;
    entry["elements"] = w.elements;
    entry["kind"] = name(w.kind);
    list.append(entry);
  }
  return list;
}

py::dict to_python(const SurfaceEnergies& e) {
  py::dict d;
  d["thin_plate"] = e.thin_plate;
  d["total_curvature"] = e.total_curvature;
  return d;
}

py::dict to_python(const LevelReport& l) {
  py::dict d;
  d["level"] = l.level;
  d["points"] = l.points;
  d["unknowns"] = l.unknowns;
  d["iterations"] = l.iterations;
  d["residual"] = l.residual;
  d["energy_error"] = l.energy_error;
  d["largest_eigenvalue"] = l.largest_eigenvalue;
  d["smoother_degree"] = l.smoother_degree;
  d["direct"] = l.direct;
  d["converged"] = l.converged;
  d["residuals"] = l.residuals;
  return d;
}

py::dict to_python(const CurvatureLevelReport& l) {
  py::dict d;
  d["level"] = l.level;
  d["plate_energy"] = l.plate_energy;
  d["start_energy"] = l.start_energy;
  d["energy"] = l.energy;
  d["start_variation"] = l.start_variation;
  d["variation"] = l.variation;
  d["folds_before"] = l.folds_before;
  d["folds"] = l.folds;
  d["converged"] = l.converged;
  d["accurate"] = l.accurate;
  py::list steps;
  for (const StepReport& s : l.steps) {
    py::dict step;
    step["functional"] = s.variation ? "minimum_variation" : "total_curvature";
    step["energy"] = s.energy;
    step["decrement"] = s.decrement;
    step["length"] = s.length;
    step["movement"] = s.movement;
    step["iterations"] = s.iterations;
    step["residual"] = s.residual;
    step["direct"] = s.direct;
    steps.append(step);
  }
  d["steps"] = steps;
  return d;
}

py::dict to_python(const ShapeReport& s) {
  py::dict d;
  d["iterations"] = s.finest.iterations;
  d["residual"] = s.finest.residual;
  d["converged"] = s.finest.converged;
  d["largest_deviation"] = s.largest_deviation;
  d["constraint_rounds"] = s.constraint_rounds;
  return d;
}

}  // namespace

py::dict to_python(const Report& r) {
  py::dict energy, seconds, d;
  energy["result"] = to_python(r.result);
  energy["polyhedron"] = to_python(r.polyhedron);
  energy["prediction"] = to_python(r.prediction);
  for (const PhaseSeconds& s : r.seconds) seconds[py::str(s.phase)] = s.seconds;
  py::list levels, iterations, residuals;
  bool converged = true;
  for (const LevelReport& l : r.levels) {
    levels.append(to_python(l));
    iterations.append(l.iterations);
    residuals.append(l.residual);
    converged &= l.converged;
  }
  d["energy"] = energy;
  d["levels"] = levels;
  py::list curvature;
  for (const CurvatureLevelReport& l : r.curvature) curvature.append(to_python(l));
  d["curvature"] = curvature;
  d["iterations"] = iterations;
  d["residuals"] = residuals;
  py::list shapes;
  for (const ShapeReport& s : r.shapes) {
    shapes.append(to_python(s));
    converged &= s.finest.converged;
  }
  d["warm"] = r.warm;
  d["converged"] = converged;
  d["shapes"] = shapes;
  d["seconds"] = seconds;
  d["predicted_bytes"] = r.predicted_bytes;
  d["peak_bytes"] = r.peak_bytes;
  d["largest_deviation"] = r.largest_deviation;
  d["constraint_rounds"] = r.constraint_rounds;
  d["constraint_gap"] = r.constraint_gap;
  d["threads"] = r.threads;
  d["warnings"] = to_python(r.warnings);
  d["flipped_faces"] = r.flipped_faces;
  return d;
}

}  // namespace fairing
