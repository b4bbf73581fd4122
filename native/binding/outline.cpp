// SPDX-License-Identifier: GPL-3.0-or-later
#include "fairing/outline.h"

#include <pybind11/stl.h>

#include "binding/arrays.h"
#include "binding/bindings.h"
#include "binding/report.h"
#include "binding/runner.h"

namespace py = pybind11;

namespace fairing {
namespace {

py::dict outline_arrays(const Numbers& vertices, const Ids& corners, const Ids& offsets,
                        const Numbers& shapes, FairOptions options, Monitor& monitor) {
  const OwnedPolygonMesh mesh = copy_of(vertices, corners, offsets);
  const std::vector<double> positions = copy_of(shapes);
  options.shapes = positions;
  Outline outline;
  run_once(monitor, py::none(), [&] { outline = outline_of(mesh.view(), options, monitor); });
  py::dict d;
  d["vertices"] = to_numpy(outline.mesh.coordinates, 3);
  d["corners"] = to_numpy(outline.mesh.corners);
  d["offsets"] = to_numpy(outline.mesh.offsets);
  d["mended"] = to_python(outline.mended ? &*outline.mended : nullptr);
  d["options"] = outline.options;
  d["centres"] = to_numpy(outline.centres, 3);
  d["face"] = to_numpy(outline.face, 4);
  d["polygon"] = to_numpy(outline.polygon);
  d["side_edge"] = to_numpy(outline.side_edge, 4);
  d["side_reversed"] = to_numpy(outline.side_reversed, 4);
  d["edge"] = to_numpy(outline.edge, 2);
  d["edge_kind"] = to_numpy(outline.edge_kind);
  d["curve"] = to_numpy(outline.curve);
  d["curve_points"] = to_numpy(outline.curve_points, 3);
  d["shapes"] = to_numpy(outline.shapes, 3);
  d["units"] = py::make_tuple(outline.units.edge, outline.units.edge_in_space, outline.units.weight,
                              outline.units.weight_in_space);
  py::dict report;
  add_mesh_report(report, outline.report);
  d["report"] = report;
  return d;
}

}  // namespace

OfWhole whole_from(const py::object& given) {
  OfWhole whole;
  if (given.is_none()) return whole;
  const auto d = given.cast<py::dict>();
  const auto pairs = copy_of(d["edges"].cast<Ids>());
  for (std::size_t k = 0; k + 1 < pairs.size(); k += 2)
    whole.curves.edges.push_back({pairs[k], pairs[k + 1]});
  whole.curves.points = copy_of(d["points"].cast<Numbers>());
  const auto units = d["units"].cast<std::array<double, 4>>();
  whole.units = {units[0], units[1], units[2], units[3]};
  whole.given = true;
  return whole;
}

void bind_outline(py::module_& m) {
  m.attr("curve_edge") = int(curve_edge);
  m.attr("boundary_edge") = int(boundary_edge);
  m.attr("split_edge") = int(split_edge);
  m.attr("straight_edge") = int(straight_edge);
  m.def("outline", &outline_arrays, exact("vertices"), exact("corners"), exact("offsets"),
        exact("shapes"), py::arg("options"), py::arg("monitor"),
        "What is decided once for a whole mesh; the package's pieces() cuts it up.");
}

}  // namespace fairing
