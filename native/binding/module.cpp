// SPDX-License-Identifier: GPL-3.0-or-later
// NumPy in, NumPy out: this folder translates and decides nothing.
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include "binding/arrays.h"
#include "binding/report.h"
#include "binding/runner.h"
#include "binding/solver.h"
#include "check/check.h"
#include "fair/fair.h"
#include "fair/memory_plan.h"

namespace py = pybind11;
using namespace fairing;

namespace {

PyObject* fairing_error_type = nullptr;

void raise(const FairingError& error) {
  const py::object type = py::reinterpret_borrow<py::object>(fairing_error_type);
  py::object value = type(error.what());
  value.attr("code") = name(error.code);
  value.attr("elements") = error.elements;
  value.attr("kind") = name(error.kind);
  PyErr_SetObject(type.ptr(), value.ptr());
}

using VertexPairs = std::vector<std::pair<std::int64_t, std::int64_t>>;

VertexPairs in_pairs(const std::vector<std::int64_t>& ids) {
  VertexPairs pairs;
  for (std::size_t i = 0; i + 1 < ids.size(); i += 2) pairs.emplace_back(ids[i], ids[i + 1]);
  return pairs;
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
    entry["repair"] = defect.repairable() ? py::object(py::str("orientation")) : py::object(py::none());
    list.append(entry);
  }
  return list;
}

py::dict fair_arrays(const Contiguous<double>& vertices, const Contiguous<std::int64_t>& corners,
                     const Contiguous<std::int64_t>& offsets, const Contiguous<double>& shapes,
                     FairOptions options, Monitor& monitor, const py::object& progress) {
  const PolygonMesh mesh{as_span(vertices), as_span(corners), as_span(offsets)};
  options.shapes = as_span(shapes);
  FairResult r;
  Runner().run([&] { r = fair(mesh, options, monitor); }, monitor, nullptr, progress);
  py::dict d;
  d["report"] = to_python(r.report);
  d["vertices"] = to_numpy(std::move(r.vertices), 3);
  py::list surfaces;
  for (Array<double>& shape : r.shapes) surfaces.append(to_numpy(std::move(shape), 3));
  d["shapes"] = surfaces;
  d["triangles"] = to_numpy(std::move(r.triangles), 3);
  d["quads"] = to_numpy(std::move(r.quads), 4);
  d["triangle_polygon"] = to_numpy(std::move(r.triangle_polygon), 1);
  d["quad_polygon"] = to_numpy(std::move(r.quad_polygon), 1);
  d["crease_edges"] = to_numpy(std::move(r.crease_edges), 2);
  return d;
}

py::list check_arrays(const Contiguous<double>& vertices, const Contiguous<std::int64_t>& corners,
                      const Contiguous<std::int64_t>& offsets, bool repair_orientation) {
  const PolygonMesh mesh{as_span(vertices), as_span(corners), as_span(offsets)};
  Findings findings;
  {
    py::gil_scoped_release release;
    findings = find_defects(mesh, {.repair_orientation = repair_orientation});
  }
  return to_python(findings.defects);
}

py::array flipped_faces(const Contiguous<double>& vertices, const Contiguous<std::int64_t>& corners,
                        const Contiguous<std::int64_t>& offsets) {
  const PolygonMesh mesh{as_span(vertices), as_span(corners), as_span(offsets)};
  std::vector<std::int64_t> faces;
  {
    py::gil_scoped_release release;
    faces = faces_to_flip(mesh);
  }
  return py::array_t<std::int64_t>(py::ssize_t(faces.size()), faces.data());
}

py::dict predicted_size(std::int64_t vertices, const Contiguous<std::int64_t>& corners,
                        const Contiguous<std::int64_t>& offsets, int levels, std::size_t shapes,
                        Energy energy) {
  const std::vector<double> none(3 * std::size_t(vertices));
  const RunSize size =
      predict_size(PolygonMesh{none, as_span(corners), as_span(offsets)}, levels, shapes, energy);
  py::dict d;
  d["vertices"] = size.points;
  d["triangles"] = size.triangles;
  d["bytes"] = size.bytes;
  return d;
}

}  // namespace

PYBIND11_MODULE(_native, m) {
  m.doc() = "The native core of discrete_fairing; use the package, not this module.";
  fairing_error_type = PyErr_NewExceptionWithDoc(
      "discrete_fairing.FairingError",
      "Base of all errors of this package.\n\n"
      "code: str, what is wrong (\"NONMANIFOLD_EDGE\", ...); elements: list of int, the ids concerned;\n"
      "kind: \"vertex\", \"edge\" (ids in pairs, end to end), \"face\" or, without elements, \"mesh\".",
      PyExc_ValueError, nullptr);
  m.attr("FairingError") =
      py::reinterpret_borrow<py::object>(fairing_error_type);  // one reference stays with raise()
  py::register_exception_translator([](std::exception_ptr p) {
    try {
      if (p) std::rethrow_exception(p);
    } catch (const FairingError& error) {
      raise(error);
    }
  });

  py::enum_<BoundaryMode>(m, "Boundary")
      .value("curve", BoundaryMode::curve)
      .value("linear", BoundaryMode::linear)
      .value("free", BoundaryMode::free);
  py::enum_<Joint>(m, "Joint")
      .value("position", Joint::position)
      .value("tangent", Joint::tangent)
      .value("curvature", Joint::curvature);
  py::enum_<ChartKind>(m, "Chart")
      .value("exponential", ChartKind::exponential)
      .value("tangent", ChartKind::tangent);
  py::enum_<Interpolation>(m, "Interpolation")
      .value("exact", Interpolation::exact)
      .value("approximate", Interpolation::approximate);
  py::enum_<Energy>(m, "Energy")
      .value("thin_plate", Energy::thin_plate)
      .value("total_curvature", Energy::total_curvature)
      .value("minimum_variation", Energy::minimum_variation);
  py::enum_<Method>(m, "Method").value("multigrid", Method::multigrid).value("back_leg", Method::back_leg);

  py::class_<Monitor>(m, "Monitor", "Watches a run, and cancels it, from any thread.")
      .def(py::init<>())
      .def("cancel", &Monitor::cancel, "Makes the run stop with the error CANCELLED, soon.")
      .def_property_readonly("fraction", &Monitor::fraction, "Share of the work done, 0 to 1.")
      .def_property_readonly(
          "phase", [](const Monitor& self) { return name(self.phase()); }, "Name of the present phase.");

  py::class_<FairOptions>(m, "Options")
      .def(py::init<>())
      .def_readwrite("levels", &FairOptions::levels)
      .def_readwrite("energy", &FairOptions::energy)
      .def_readwrite("step_tolerance", &FairOptions::step_tolerance)
      .def_readwrite("max_steps", &FairOptions::max_steps)
      .def_property(
          "chart", [](const FairOptions& o) { return o.chart.kind; },
          [](FairOptions& o, ChartKind kind) { o.chart.kind = kind; })
      .def_property(
          "metric_exponent", [](const FairOptions& o) { return o.chart.exponent; },
          [](FairOptions& o, double v) { o.chart.exponent = v; })
      .def_property(
          "chart_blend", [](const FairOptions& o) { return o.chart.blend; },
          [](FairOptions& o, double v) { o.chart.blend = v; })
      .def_property(
          "crease_edges", [](const FairOptions& o) { return o.features.crease_edges; },
          [](FairOptions& o, std::vector<std::array<std::int64_t, 2>> v) {
            o.features.crease_edges = std::move(v);
          })
      .def_property(
          "corner_vertices", [](const FairOptions& o) { return o.features.corner_vertices; },
          [](FairOptions& o, std::vector<std::int64_t> v) { o.features.corner_vertices = std::move(v); })
      .def_property(
          "crease_angle", [](const FairOptions& o) { return o.features.crease_angle; },
          [](FairOptions& o, double v) { o.features.crease_angle = v; })
      .def_property(
          "corner_angle", [](const FairOptions& o) { return o.features.corner_angle; },
          [](FairOptions& o, double v) { o.features.corner_angle = v; })
      .def_property(
          "boundary", [](const FairOptions& o) { return o.features.boundary; },
          [](FairOptions& o, BoundaryMode v) { o.features.boundary = v; })
      .def_property(
          "region", [](const FairOptions& o) { return o.features.region.faces; },
          [](FairOptions& o, std::vector<std::int64_t> v) {
            o.features.region.given = true;
            o.features.region.faces = std::move(v);
          })
      .def_property(
          "joint", [](const FairOptions& o) { return o.features.region.joint; },
          [](FairOptions& o, Joint v) { o.features.region.joint = v; })
      .def_readwrite("repair_orientation", &FairOptions::repair_orientation)
      .def_readwrite("interpolation", &FairOptions::interpolation)
      .def_readwrite("tolerance", &FairOptions::tolerance)
      .def_readwrite("weights", &FairOptions::weights)
      .def_readwrite("epsilon", &FairOptions::epsilon)
      .def_readwrite("method", &FairOptions::method)
      .def_readwrite("relative_residual", &FairOptions::relative_residual)
      .def_readwrite("max_iterations", &FairOptions::max_iterations)
      .def_readwrite("smoother_degree", &FairOptions::smoother_degree)
      .def_readwrite("sweeps", &FairOptions::sweeps)
      .def_readwrite("threads", &FairOptions::threads)
      .def_readwrite("memory_limit", &FairOptions::memory_limit)
      .def_readwrite("measure", &FairOptions::measure);

  m.def("fair", &fair_arrays, py::arg("vertices").noconvert(), py::arg("corners").noconvert(),
        py::arg("offsets").noconvert(), py::arg("shapes").noconvert(), py::arg("options"), py::arg("monitor"),
        py::arg("progress"));
  m.def("check", &check_arrays, py::arg("vertices").noconvert(), py::arg("corners").noconvert(),
        py::arg("offsets").noconvert(), py::arg("repair_orientation"));
  m.def("faces_to_flip", &flipped_faces, py::arg("vertices").noconvert(), py::arg("corners").noconvert(),
        py::arg("offsets").noconvert());
  m.def("predicted_size", &predicted_size, py::arg("vertices"), py::arg("corners").noconvert(),
        py::arg("offsets").noconvert(), py::arg("levels"), py::arg("shapes"), py::arg("energy"));
  bind_solver(m);
#ifdef DF_VERSION
  m.attr("__version__") = DF_VERSION;
#else
  m.attr("__version__") = "0";
#endif
}
