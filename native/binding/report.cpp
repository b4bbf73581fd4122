// SPDX-License-Identifier: GPL-3.0-or-later
#include "binding/report.h"

#include <pybind11/stl.h>

#include "binding/arrays.h"
#include "fairing/fixed_normals.h"

namespace py = pybind11;
using namespace pybind11::literals;

namespace fairing {
namespace {

py::dict to_python(const SurfaceEnergies& e) {
  return py::dict("thin_plate"_a = e.thin_plate, "total_curvature"_a = e.total_curvature);
}

py::dict to_python(const LevelReport& l) {
  return py::dict(
      "level"_a = l.level, "points"_a = l.points, "unknowns"_a = l.unknowns,
      "iterations"_a = l.iterations, "residual"_a = l.residual, "energy_error"_a = l.energy_error,
      "largest_eigenvalue"_a = l.largest_eigenvalue, "smoother_degree"_a = l.smoother_degree,
      "direct"_a = l.direct, "lines"_a = l.lines, "converged"_a = l.converged,
      "residuals"_a = l.residuals, "pad_corrections"_a = l.pad_corrections,
      "pad_force"_a = l.pad_force, "constraint_rounds"_a = l.constraint_rounds,
      "constraint_gap"_a = l.constraint_gap, "normal_angle"_a = l.normal_angle / degree);
}

py::dict to_python(const StepWork& w) {
  return py::dict("steps"_a = w.steps, "linearizations"_a = w.linearizations,
                  "iterations"_a = w.iterations, "pad_corrections"_a = w.pad_corrections,
                  "factors"_a = w.factors);
}

py::dict to_python(const CurvatureLevelReport& l) {
  py::list steps;
  for (const StepReport& s : l.steps) {
    const char* const functional = s.variation ? "minimum_variation" : "total_curvature";
    steps.append(py::dict(
        "functional"_a = functional, "energy"_a = s.energy, "decrement"_a = s.decrement,
        "length"_a = s.length, "movement"_a = s.movement, "iterations"_a = s.iterations,
        "residual"_a = s.residual, "direct"_a = s.direct, "pad_corrections"_a = s.pad_corrections,
        "constraint_rounds"_a = s.constraint_rounds));
  }
  return py::dict("level"_a = l.level, "plate_energy"_a = l.plate_energy,
                  "start_energy"_a = l.start_energy, "energy"_a = l.energy,
                  "start_variation"_a = l.start_variation, "variation"_a = l.variation,
                  "damped"_a = l.damped, "folds_before"_a = l.folds_before, "folds"_a = l.folds,
                  "constraint_gap"_a = l.constraint_gap, "left"_a = l.left,
                  "converged"_a = l.converged, "kept_start"_a = l.kept_start,
                  "swollen"_a = l.swollen, "work"_a = to_python(l.work), "steps"_a = steps);
}

py::dict to_python(const ShapeReport& s) {
  return py::dict("iterations"_a = s.finest.iterations, "residual"_a = s.finest.residual,
                  "converged"_a = s.converged, "largest_deviation"_a = s.largest_deviation,
                  "constraint_rounds"_a = s.constraint_rounds, "normal_angle"_a = s.normal_angle);
}

py::dict to_python(const NormalReport& n) {
  return py::dict("fixed"_a = n.fixed, "largest_angle"_a = n.largest_angle);
}

py::dict to_python(const PadReport& p) {
  return py::dict("gone"_a = p.gone, "widths"_a = p.widths);
}

py::dict to_python(const SheetReport& s) {
  return py::dict("count"_a = s.count, "nonmanifold_edges"_a = s.nonmanifold_edges,
                  "nonmanifold_vertices"_a = s.nonmanifold_vertices, "one_sided"_a = s.one_sided);
}

py::list to_python(const std::vector<Warning>& warnings) {
  py::list list;
  for (const Warning& w : warnings) {
    list.append(py::dict("code"_a = w.code, "cause"_a = w.message.cause, "cure"_a = w.message.cure,
                         "elements"_a = w.elements, "kind"_a = name(w.kind)));
  }
  return list;
}

using VertexPairs = std::vector<std::pair<std::int64_t, std::int64_t>>;

VertexPairs pairs_of(const std::vector<std::int64_t>& ids) {
  VertexPairs pairs;
  for (std::size_t i = 0; i + 1 < ids.size(); i += 2) pairs.emplace_back(ids[i], ids[i + 1]);
  return pairs;
}

}  // namespace

py::dict to_python(const Report& r) {
  const py::dict energy("result"_a = to_python(r.result), "polyhedron"_a = to_python(r.polyhedron),
                        "prediction"_a = to_python(r.prediction));
  py::dict seconds;
  py::list levels, iterations, residuals, curvature, shapes;
  bool converged = r.converged();
  for (const LevelReport& l : r.levels) {
    levels.append(to_python(l));
    iterations.append(l.iterations);
    residuals.append(l.residual);
  }
  for (const CurvatureLevelReport& l : r.curvature) curvature.append(to_python(l));
  for (const ShapeReport& s : r.shapes) {
    shapes.append(to_python(s));
    converged &= s.converged;
  }
  for (const PhaseSeconds& s : r.seconds) seconds[py::str(s.phase)] = s.seconds;
  py::dict d("energy"_a = energy, "levels"_a = levels, "iterations"_a = iterations,
             "residuals"_a = residuals, "converged"_a = converged, "curvature"_a = curvature,
             "warm"_a = r.warm, "shapes"_a = shapes, "seconds"_a = seconds,
             "predicted_bytes"_a = r.predicted_bytes, "peak_bytes"_a = r.peak_bytes,
             "largest_deviation"_a = r.largest_deviation,
             "constraint_rounds"_a = r.constraint_rounds, "constraint_gap"_a = r.constraint_gap,
             "pads"_a = to_python(r.pads), "normals"_a = to_python(r.normals),
             "threads"_a = r.threads);
  add_mesh_report(d, r);
  return d;
}

void add_mesh_report(py::dict& to, const Report& r) {
  to["sheets"] = to_python(r.sheets);
  to["warnings"] = to_python(r.warnings);
  to["repairs"] = to_python(r.repairs);
  to["flipped_faces"] = r.flipped_faces;
}

py::dict to_python(const RunSize& size) {
  return py::dict("vertices"_a = size.points, "triangles"_a = size.triangles,
                  "bytes"_a = size.bytes);
}

py::list to_python(const Defects& defects) {
  py::list list;
  for (const Defect& defect : defects) {
    const bool in_pairs = defect.kind == ElementKind::edge;
    list.append(py::dict(
        "code"_a = name(defect.code),
        "message"_a = text(defect.message, defect.kind, defect.elements),
        "elements"_a = in_pairs ? py::cast(pairs_of(defect.elements)) : py::cast(defect.elements),
        "kind"_a = name(defect.kind),
        "severity"_a = defect.severity == Severity::error ? "error" : "warning",
        "repairable"_a = defect.repairable));
  }
  return list;
}

py::dict to_python(const FairingError& error) {
  return py::dict("code"_a = name(error.code), "cause"_a = error.message.cause,
                  "cure"_a = error.message.cure, "elements"_a = error.elements,
                  "kind"_a = name(error.kind));
}

py::object to_python(const MendedMesh* mended) {
  if (!mended) return py::none();
  const auto& origins = mended->corner_origin;
  const auto size = py::ssize_t(origins.size());
  py::array_t<std::int32_t> corner({size, py::ssize_t(2)});
  py::array_t<double> share(size);
  for (py::ssize_t k = 0; k < size; ++k) {
    const CornerOrigin& origin = origins[k];
    corner.mutable_at(k, 0) = origin.from;
    corner.mutable_at(k, 1) = origin.beside;
    share.mutable_at(k) = origin.share;
  }
  return py::dict("corners"_a = to_numpy(mended->mesh.corners),
                  "offsets"_a = to_numpy(mended->mesh.offsets),
                  "vertex_origin"_a = to_numpy(mended->vertex_origin),
                  "face_origin"_a = to_numpy(mended->face_origin), "corner_origin"_a = corner,
                  "corner_share"_a = share);
}

void add_faces(py::dict& to, OutputFaces&& faces, Array<std::int32_t>&& crease_edges) {
  to["triangles"] = to_numpy(std::move(faces.triangles), 3);
  to["quads"] = to_numpy(std::move(faces.quads), 4);
  to["triangle_polygon"] = to_numpy(std::move(faces.triangle_polygon), 1);
  to["quad_polygon"] = to_numpy(std::move(faces.quad_polygon), 1);
  if (!faces.triangle_mended.empty() || !faces.quad_mended.empty()) {
    to["triangle_mended"] = to_numpy(std::move(faces.triangle_mended), 1);
    to["quad_mended"] = to_numpy(std::move(faces.quad_mended), 1);
  }
  to["crease_edges"] = to_numpy(std::move(crease_edges), 2);
}

}  // namespace fairing
