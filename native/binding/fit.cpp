// SPDX-License-Identifier: GPL-3.0-or-later
#include "fit/fit_scan.h"

#include <pybind11/stl.h>

#include "binding/arrays.h"
#include "binding/bindings.h"
#include "binding/report.h"
#include "binding/runner.h"

namespace py = pybind11;

namespace fairing {
namespace {

py::dict fit_arrays(const Numbers& vertices, const Ids& corners, const Ids& offsets,
                    const Numbers& points, const Numbers& normals, const Ids& triangles,
                    double tolerance, double weight, const Contiguous<std::uint8_t>& fixed,
                    const FairOptions& options, Monitor& monitor, const py::object& progress) {
  const OwnedPolygonMesh mesh = copy_of(vertices, corners, offsets);
  const ScanInput scan{copy_of(points), copy_of(normals), copy_of(triangles)};
  const FitSettings settings{tolerance, weight, copy_of(fixed)};
  const FairOptions own = options;
  FitResult result;
  run_once(monitor, progress,
           [&] { result = fit_scan(mesh.view(), own, scan, settings, monitor); });
  py::dict d;
  d["vertices"] = to_numpy(std::move(result.vertices), 3);
  d["shapes"] = py::list();
  add_faces(d, std::move(result.faces), std::move(result.crease_edges));
  d["report"] = to_python(result.report);
  d["mended"] = to_python(result.mended ? &*result.mended : nullptr);
  FitReport& fit = result.fit;
  d["distances"] = to_numpy(std::move(fit.distances), 1);
  d["faces_of_points"] = to_numpy(std::move(fit.faces), 1);
  d["noise"] = fit.noise;
  d["weight"] = fit.weight;
  d["within"] = py::make_tuple(fit.within, fit.largest);
  d["coverage"] = to_numpy(fit.coverage);
  d["too_coarse"] = to_numpy(fit.too_coarse);
  d["outliers"] = to_numpy(fit.outliers);
  d["trials"] = fit.trials;
  d["iterations"] = fit.iterations;
  return d;
}

}  // namespace

void bind_fit(py::module_& m) {
  m.def("fit", &fit_arrays, exact("vertices"), exact("corners"), exact("offsets"), exact("points"),
        exact("normals"), exact("triangles"), py::arg("tolerance"), py::arg("weight"),
        exact("fixed"), py::arg("options"), py::arg("monitor"), py::arg("progress"),
        "discrete_fairing.fit on plain arrays. Returns what Fitted takes.");
}

}  // namespace fairing
