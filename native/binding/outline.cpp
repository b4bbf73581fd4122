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

template <class T>
py::array column(const std::vector<T>& values) {
  return py::array_t<T>(py::ssize_t(values.size()), values.data());
}

template <class T>
py::array rows(const std::vector<T>& values, std::size_t columns) {
  return py::array_t<T>({py::ssize_t(values.size() / columns), py::ssize_t(columns)},
                        values.data());
}

py::dict outline_arrays(const Contiguous<double>& vertices, const Contiguous<std::int64_t>& corners,
                        const Contiguous<std::int64_t>& offsets, const Contiguous<double>& shapes,
                        FairOptions options, Monitor& monitor) {
  const OwnedPolygonMesh mesh = copy_of(vertices, corners, offsets);
  const std::vector<double> positions = copy_of(shapes);
  options.shapes = positions;
  Outline outline;
  Runner().run([&] { outline = outline_of(mesh.view(), options, monitor); }, monitor, nullptr,
               py::none());
  py::dict d;
  d["vertices"] = rows(outline.mesh.coordinates, 3);
  d["corners"] = column(outline.mesh.corners);
  d["offsets"] = column(outline.mesh.offsets);
  d["mended"] = to_python(outline.mended ? &*outline.mended : nullptr);
  d["options"] = outline.options;
  d["centres"] = rows(outline.centres, 3);
  d["face"] = rows(outline.face, 4);
  d["polygon"] = column(outline.polygon);
  d["side_edge"] = rows(outline.side_edge, 4);
  d["side_reversed"] = rows(outline.side_reversed, 4);
  d["edge"] = rows(outline.edge, 2);
  d["edge_kind"] = column(outline.edge_kind);
  d["curve"] = column(outline.curve);
  d["curve_points"] = rows(outline.curve_points, 3);
  d["shapes"] = rows(outline.shapes, 3);
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
  const auto pairs = copy_of(d["edges"].cast<Contiguous<std::int64_t>>());
  for (std::size_t k = 0; k + 1 < pairs.size(); k += 2)
    whole.curves.edges.push_back({pairs[k], pairs[k + 1]});
  whole.curves.points = copy_of(d["points"].cast<Contiguous<double>>());
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
  m.def("outline", &outline_arrays, py::arg("vertices").noconvert(), py::arg("corners").noconvert(),
        py::arg("offsets").noconvert(), py::arg("shapes").noconvert(), py::arg("options"),
        py::arg("monitor"),
        "What is decided once for a whole mesh; the package's pieces() cuts it up.");
}

}  // namespace fairing
