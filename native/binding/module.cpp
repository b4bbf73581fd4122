// SPDX-License-Identifier: GPL-3.0-or-later
// The module discrete_fairing._native: NumPy arrays in, NumPy arrays out. This folder only
// translates: the package makes C-contiguous arrays of the right types and checks the form of all
// settings (discrete_fairing/arrays.py, options.py); the core checks their meaning.
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <new>

#include "binding/arrays.h"
#include "binding/bindings.h"
#include "binding/construct.h"
#include "binding/report.h"
#include "binding/runner.h"
#include "binding/running.h"
#include "fairing/fair.h"
#include "fairing/memory_plan.h"
#include "fairing/mending.h"
#include "mesh/validate/check.h"
#include "parallel/cancel.h"

namespace py = pybind11;
using namespace fairing;

namespace {

PyObject* fairing_error_type = nullptr;

// The package's own errors have codes that are not in the core.
py::object python_error(const std::string& code, const std::string& cause, const std::string& cure,
                        const std::vector<std::int64_t>& elements, const std::string& kind) {
  const ElementKind of = kind_named(kind);
  py::object value = py::reinterpret_borrow<py::object>(fairing_error_type)(
      text(Message(cause, cure), of, elements));
  value.attr("code") = code;
  value.attr("cause") = text(cause, of, elements);
  value.attr("cure") = text(cure, of, elements);
  value.attr("elements") = elements;
  value.attr("kind") = kind;
  value.attr("_sentences") = py::make_tuple(cause, cure);
  return value;
}

void set_python_error(const FairingError& error) {
  const py::object value = python_error(name(error.code), error.message.cause, error.message.cure,
                                        error.elements, name(error.kind));
  PyErr_SetObject(fairing_error_type, value.ptr());
}

// FairingError is the only exception of the core and of this module.
void bind_errors(py::module_& m) {
  fairing_error_type = PyErr_NewExceptionWithDoc(
      "discrete_fairing.FairingError",
      "Base of all errors of this package.\n\n"
      "code: str, what is wrong (\"DUPLICATE_FACE\", ...); cause, cure: str, the same as a\n"
      "sentence, and what to do about it (or empty); elements: list of int, the ids concerned;\n"
      "kind: \"vertex\", \"edge\" (ids in pairs, end to end), \"face\" or, without elements,\n"
      "\"mesh\".",
      PyExc_ValueError, nullptr);
  // set_python_error() keeps one reference.
  m.attr("FairingError") = py::reinterpret_borrow<py::object>(fairing_error_type);
  py::register_exception_translator([](std::exception_ptr p) {
    try {
      if (p) std::rethrow_exception(p);
    } catch (const FairingError& error) {
      set_python_error(error);
    } catch (const std::bad_alloc&) {
      set_python_error(out_of_memory());
    }
  });
}

void bind_monitor(py::module_& m) {
  py::class_<Monitor> monitor(m, "Monitor", "Watches a run, and cancels it, from any thread.");
  define_constructor(monitor);
  monitor
      // for calls of the package with several runs, each with its own monitor
      .def("_report",
           [](Monitor& self, const std::string& phase, double fraction) {
             for (Phase known = Phase::check; known <= Phase::done; known = Phase(int(known) + 1))
               if (name(known) == phase) self.report(known, fraction);
           })
      .def("cancel", &Monitor::cancel, "Makes the run stop soon, with the error CANCELLED.")
      .def_property_readonly("fraction", &Monitor::fraction,
                             "How much of the work is done, from 0 to 1; never decreases.")
      .def_property_readonly(
          "phase", [](const Monitor& self) { return name(self.phase()); },
          "Name of the present phase, a key of report[\"seconds\"]; \"done\" at the end.");
}

py::dict fair_arrays(const Numbers& vertices, const Ids& corners, const Ids& offsets,
                     const Numbers& shapes, FairOptions options, Monitor& monitor,
                     const py::object& progress, const py::object& whole) {
  const OwnedPolygonMesh mesh = copy_of(vertices, corners, offsets);
  const std::vector<double> positions = copy_of(shapes);
  options.shapes = positions;
  options.whole = whole_from(whole);
  FairResult result;
  run_once(monitor, progress, [&] { result = fair(mesh.view(), options, monitor); });
  py::dict d;
  d["vertices"] = to_numpy(std::move(result.vertices), 3);
  py::list surfaces;
  for (Array<double>& shape : result.shapes) surfaces.append(to_numpy(std::move(shape), 3));
  d["shapes"] = surfaces;
  add_faces(d, std::move(result.faces), std::move(result.crease_edges));
  d["report"] = to_python(result.report);
  d["mended"] = to_python(result.mended ? &*result.mended : nullptr);
  return d;
}

// Runs a short call without progress, on this thread and without Python's lock.
template <class Call>
auto beside_python(Call&& call) {
  Monitor monitor;
  const RunningScope running(monitor);
  const CancelScope scope(&monitor);
  const py::gil_scoped_release release;
  return call();
}

py::list check_arrays(const Numbers& vertices, const Ids& corners, const Ids& offsets) {
  const OwnedPolygonMesh mesh = copy_of(vertices, corners, offsets);
  const Findings findings = beside_python([&] { return find_defects(mesh.view()); });
  return to_python(findings.defects);
}

void readable_arrays(const Numbers& vertices, const Ids& corners, const Ids& offsets,
                     Repair repair) {
  const OwnedPolygonMesh mesh = copy_of(vertices, corners, offsets);
  beside_python([&] { require_readable(mesh.view(), repair); });
}

py::dict predicted_size(std::int64_t vertices, const Ids& corners, const Ids& offsets, int levels,
                        std::size_t shapes, Energy energy) {
  const OwnedPolygonMesh faces = copy_of({}, corners, offsets);
  require_faces(faces.corners, faces.offsets);
  FairOptions options;
  options.levels = levels;
  options.energy = energy;
  return to_python(predict_size(vertices, faces.corners, faces.offsets, shapes, options));
}

std::string text_of(const std::string& sentence, const std::string& kind,
                    const std::vector<std::int64_t>& ids) {
  return text(sentence, kind_named(kind), ids);
}

}  // namespace

PYBIND11_MODULE(_native, m) {
  m.doc() = "The native core of discrete_fairing; use the package, not this module.";
  bind_errors(m);
  bind_monitor(m);
  bind_options(m);
  m.def("fair", &fair_arrays, exact("vertices"), exact("corners"), exact("offsets"),
        exact("shapes"), py::arg("options"), py::arg("monitor"), py::arg("progress"),
        py::arg("whole") = py::none(),
        "discrete_fairing.fair on plain arrays: vertices (n, 3) and shapes (k, n, 3) float64,\n"
        "corners and offsets int64. Returns what Result takes.");
  m.def("check", &check_arrays, exact("vertices"), exact("corners"), exact("offsets"),
        "The arguments of Defect for each defect of a mesh.");
  m.def("require_readable", &readable_arrays, exact("vertices"), exact("corners"), exact("offsets"),
        py::arg("repair"),
        "Raises what fair() would for these arrays before it looks at the mesh.");
  m.def("predicted_size", &predicted_size, py::arg("vertices"), exact("corners"), exact("offsets"),
        py::arg("levels"), py::arg("shapes"), py::arg("energy"),
        "What a run of so many vertices and these faces makes and takes.");
  m.def("error", &python_error, py::arg("code"), py::arg("cause"), py::arg("cure"),
        py::arg("elements"), py::arg("kind"),
        "A FairingError; its sentences have places for the elements (native/base/error.h).");
  m.def("text", &text_of, py::arg("sentence"), py::arg("kind"), py::arg("elements"),
        "A sentence with the elements in their places.");
  bind_solver(m);
  bind_strain(m);
  bind_fit(m);
  bind_outline(m);
  bind_splines(m);
  bind_fill(m);
  bind_clean(m);
  bind_joints(m);
  bind_end();
#ifdef DF_VERSION
  m.attr("__version__") = DF_VERSION;
#else
  m.attr("__version__") = "0";
#endif
}
