// SPDX-License-Identifier: GPL-3.0-or-later
#include "binding/report.h"

#include <pybind11/stl.h>

#include "binding/arrays.h"
#include "fairing/fixed_normals.h"

namespace py = pybind11;

namespace fairing {
namespace {

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
  d["blocks"] = l.blocks;
  d["converged"] = l.converged;
  d["residuals"] = l.residuals;
  d["pad_corrections"] = l.pad_corrections;
  d["pad_force"] = l.pad_force;
  d["constraint_rounds"] = l.constraint_rounds;
  d["constraint_gap"] = l.constraint_gap;
  d["normal_angle"] = l.normal_angle / degree;
  return d;
}

py::dict to_python(const StepWork& w) {
  py::dict d;
  d["steps"] = w.steps;
  d["linearizations"] = w.linearizations;
  d["iterations"] = w.iterations;
  d["pad_corrections"] = w.pad_corrections;
  d["factors"] = w.factors;
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
  d["damped"] = l.damped;
  d["folds_before"] = l.folds_before;
  d["folds"] = l.folds;
  d["constraint_gap"] = l.constraint_gap;
  d["left"] = l.left;
  d["converged"] = l.converged;
  d["kept_start"] = l.kept_start;
  d["work"] = to_python(l.work);
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
    step["pad_corrections"] = s.pad_corrections;
    step["constraint_rounds"] = s.constraint_rounds;
    steps.append(step);
  }
  d["steps"] = steps;
  return d;
}

py::dict to_python(const ShapeReport& s) {
  py::dict d;
  d["iterations"] = s.finest.iterations;
  d["residual"] = s.finest.residual;
  d["converged"] = s.converged;
  d["largest_deviation"] = s.largest_deviation;
  d["constraint_rounds"] = s.constraint_rounds;
  d["normal_angle"] = s.normal_angle;
  return d;
}

py::dict to_python(const NormalReport& n) {
  py::dict d;
  d["fixed"] = n.fixed;
  d["largest_angle"] = n.largest_angle;
  return d;
}

py::dict to_python(const PadReport& p) {
  py::dict d;
  d["gone"] = p.gone;
  d["widths"] = p.widths;
  return d;
}

py::dict to_python(const SheetReport& s) {
  py::dict d;
  d["count"] = s.count;
  d["nonmanifold_edges"] = s.nonmanifold_edges;
  d["nonmanifold_vertices"] = s.nonmanifold_vertices;
  d["one_sided"] = s.one_sided;
  return d;
}

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

using VertexPairs = std::vector<std::pair<std::int64_t, std::int64_t>>;

VertexPairs in_pairs(const std::vector<std::int64_t>& ids) {
  VertexPairs pairs;
  for (std::size_t i = 0; i + 1 < ids.size(); i += 2) pairs.emplace_back(ids[i], ids[i + 1]);
  return pairs;
}

}  // namespace

py::dict to_python(const Report& r) {
  py::dict energy, seconds, d;
  energy["result"] = to_python(r.result);
  energy["polyhedron"] = to_python(r.polyhedron);
  energy["prediction"] = to_python(r.prediction);
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
  d["energy"] = energy;
  d["levels"] = levels;
  d["iterations"] = iterations;
  d["residuals"] = residuals;
  d["converged"] = converged;
  d["curvature"] = curvature;
  d["warm"] = r.warm;
  d["shapes"] = shapes;
  d["seconds"] = seconds;
  d["predicted_bytes"] = r.predicted_bytes;
  d["peak_bytes"] = r.peak_bytes;
  d["largest_deviation"] = r.largest_deviation;
  d["constraint_rounds"] = r.constraint_rounds;
  d["constraint_gap"] = r.constraint_gap;
  d["pads"] = to_python(r.pads);
  d["normals"] = to_python(r.normals);
  d["threads"] = r.threads;
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
  py::dict d;
  d["vertices"] = size.points;
  d["triangles"] = size.triangles;
  d["bytes"] = size.bytes;
  return d;
}

py::list to_python(const Defects& defects) {
  py::list list;
  for (const Defect& defect : defects) {
    py::dict entry;
    entry["code"] = name(defect.code);
    entry["message"] = defect.message;
    if (defect.kind == ElementKind::edge)
      entry["elements"] = in_pairs(defect.elements);
    else
      entry["elements"] = defect.elements;
    entry["kind"] = name(defect.kind);
    entry["severity"] = defect.severity == Severity::error ? "error" : "warning";
    entry["repairable"] = defect.repairable;
    list.append(entry);
  }
  return list;
}

py::object to_python(const MendedMesh* mended) {
  if (!mended) return py::none();
  const auto& origins = mended->corner_origin;
  const auto size = py::ssize_t(origins.size());
  py::array_t<std::int32_t> corner({size, py::ssize_t(2)});
  py::array_t<double> share(size);
  for (py::ssize_t k = 0; k < size; ++k) {
    const CornerOrigin& origin = origins[std::size_t(k)];
    corner.mutable_at(k, 0) = origin.from;
    corner.mutable_at(k, 1) = origin.beside;
    share.mutable_at(k) = origin.share;
  }
  const auto copy = [](const auto& values) {
    return py::array_t<typename std::remove_cvref_t<decltype(values)>::value_type>(
        py::ssize_t(values.size()), values.data());
  };
  py::dict d;
  d["corners"] = copy(mended->mesh.corners);
  d["offsets"] = copy(mended->mesh.offsets);
  d["vertex_origin"] = copy(mended->vertex_origin);
  d["face_origin"] = copy(mended->face_origin);
  d["corner_origin"] = corner;
  d["corner_share"] = share;
  return d;
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
