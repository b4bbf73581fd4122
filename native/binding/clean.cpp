// SPDX-License-Identifier: GPL-3.0-or-later
// Functions for the package's clean(): mending, flipping faces, joined components.
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include "binding/arrays.h"
#include "binding/bindings.h"
#include "binding/report.h"
#include "binding/runner.h"
#include "mesh/mend/mend.h"
#include "mesh/orientation.h"
#include "mesh/union_find.h"

namespace py = pybind11;

namespace fairing {
namespace {

// As to_python(), with "acts": codes with numbers of elements; None if nothing was wrong.
py::object mended_arrays(const Numbers& vertices, const Ids& corners, const Ids& offsets,
                         Monitor& monitor, const py::object& progress) {
  const OwnedPolygonMesh mesh = copy_of(vertices, corners, offsets);
  MendedMesh mended;
  run_once(monitor, progress, [&] { mended = mend(mesh.view()); });
  if (!mended.changed()) return py::none();
  py::dict found = to_python(&mended);
  py::list acts;
  for (const Warning& act : mended.acts) acts.append(py::make_tuple(act.code, act.elements.size()));
  found["acts"] = acts;
  return found;
}

// (k,) int64 faces to flip so that neighbours agree.
py::array to_flip(const Numbers& vertices, const Ids& corners, const Ids& offsets, Monitor& monitor,
                  const py::object& progress) {
  const OwnedPolygonMesh mesh = copy_of(vertices, corners, offsets);
  std::vector<std::int64_t> faces;
  run_once(monitor, progress, [&] {
    const HalfEdges half_edges(mesh.view());
    faces = find_orientation(mesh.view(), half_edges).to_flip;
  });
  return to_numpy(faces);
}

// (count,) int32: for 0 … count - 1, joined by `pairs` (k, 2), the least number of each component.
py::array joined(std::size_t count, const Ids& pairs) {
  const std::vector<std::int64_t> ids = copy_of(pairs);
  Array<std::int32_t> leads(count);
  {
    const py::gil_scoped_release release;
    UnionFind groups(count);
    for (std::size_t k = 0; k + 1 < ids.size(); k += 2)
      groups.unite(Index(ids[k]), Index(ids[k + 1]));
    for (std::size_t i = 0; i < count; ++i) leads[i] = groups.lead(Index(i));
  }
  return to_numpy(std::move(leads), 1);
}

}  // namespace

void bind_clean(py::module_& m) {
  m.def("mended", &mended_arrays, exact("vertices"), exact("corners"), exact("offsets"),
        py::arg("monitor"), py::arg("progress"), "For the package's clean().");
  m.def("to_flip", &to_flip, exact("vertices"), exact("corners"), exact("offsets"),
        py::arg("monitor"), py::arg("progress"),
        "Faces that must turn over for neighbours to agree.");
  m.def("joined", &joined, py::arg("count"), exact("pairs"),
        "Of numbers joined by pairs, the least that each hangs together with.");
}

}  // namespace fairing
