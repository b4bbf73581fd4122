// SPDX-License-Identifier: GPL-3.0-or-later
// NumPy in, NumPy out: this file translates and decides nothing.
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <condition_variable>
#include <mutex>
#include <thread>

#include "check/check.h"
#include "fair/fair.h"
#include "fair/memory_plan.h"

namespace py = pybind11;
using namespace fairing;

namespace {

template <class T>
using Contiguous = py::array_t<T, py::array::c_style>;

template <class T>
std::span<const T> as_span(const Contiguous<T>& a) {
  return {a.data(), std::size_t(a.size())};
}

// Hands an Array over to NumPy without a copy.
template <class T>
py::array to_numpy(Array<T>&& values, py::ssize_t columns) {
  auto owner = std::make_unique<Array<T>>(std::move(values));
  T* data = owner->data();
  const auto size = py::ssize_t(owner->size());
  py::capsule free_later(owner.release(), [](void* p) { delete static_cast<Array<T>*>(p); });
  if (columns == 1) return py::array_t<T>({size}, data, free_later);
  return py::array_t<T>({size / columns, columns}, data, free_later);
}

PyObject* fairing_error_type = nullptr;

void raise(const FairingError& error) {
  const py::object type = py::reinterpret_borrow<py::object>(fairing_error_type);
  py::object value = type(error.what());
  value.attr("code") = name(error.code);
  value.attr("elements") = error.elements;
  value.attr("kind") = name(error.kind);
  PyErr_SetObject(type.ptr(), value.ptr());
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

// Runs on a thread of its own while the calling thread looks after Python: progress, Ctrl-C.
FairResult run_watched(const PolygonMesh& mesh, const FairOptions& options, Monitor& monitor,
                       const py::object& progress) {
  FairResult result;
  std::exception_ptr failure;
  std::mutex mutex;
  std::condition_variable finished;
  bool done = false;
  std::thread runner([&] {
    try {
      result = fair(mesh, options, monitor);
    } catch (...) {
      failure = std::current_exception();
    }
    const std::lock_guard lock(mutex);
    done = true;
    finished.notify_all();
  });
  std::exception_ptr python_failure;
  double last_fraction = -1;
  const auto ask_python = [&] {
    try {
      if (PyErr_CheckSignals() != 0) throw py::error_already_set();
      if (progress.is_none()) return;
      const double fraction = monitor.fraction();
      const py::object answer = progress(std::max(fraction, last_fraction), name(monitor.phase()));
      last_fraction = std::max(fraction, last_fraction);
      if (answer.is(py::bool_(false))) monitor.cancel();
    } catch (...) {
      python_failure = std::current_exception();
      monitor.cancel();
    }
  };
  for (bool over = false; !over;) {
    {
      py::gil_scoped_release release;
      std::unique_lock lock(mutex);
      over = finished.wait_for(lock, std::chrono::milliseconds(25), [&] { return done; });
    }
    if (!over && !python_failure) ask_python();
  }
  {
    py::gil_scoped_release release;
    runner.join();
  }
  if (!python_failure && !failure) ask_python();
  if (python_failure) std::rethrow_exception(python_failure);
  if (failure) std::rethrow_exception(failure);
  return result;
}

py::dict fair_arrays(const Contiguous<double>& vertices, const Contiguous<std::int64_t>& corners,
                     const Contiguous<std::int64_t>& offsets, const Contiguous<double>& shapes,
                     FairOptions options, Monitor& monitor, const py::object& progress) {
  const PolygonMesh mesh{as_span(vertices), as_span(corners), as_span(offsets)};
  options.shapes = as_span(shapes);
  FairResult r = run_watched(mesh, options, monitor, progress);
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
#ifdef DF_VERSION
  m.attr("__version__") = DF_VERSION;
#else
  m.attr("__version__") = "0";
#endif
}
