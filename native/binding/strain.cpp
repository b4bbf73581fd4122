// SPDX-License-Identifier: GPL-3.0-or-later
#include "fairing/strain.h"

#include "binding/arrays.h"
#include "binding/bindings.h"
#include "binding/runner.h"

namespace py = pybind11;

namespace fairing {
namespace {

py::dict strain_of_arrays(const Contiguous<double>& vertices,
                          const Contiguous<std::int64_t>& corners,
                          const Contiguous<std::int64_t>& offsets, const FairOptions& options,
                          Monitor& monitor, const py::object& progress) {
  const OwnedPolygonMesh mesh = copy_of(vertices, corners, offsets);
  const FairOptions own = options;
  Strain strain;
  Runner().run([&] { strain = measure_strain(mesh.view(), own, monitor); }, monitor, nullptr,
               progress);
  const auto size = py::ssize_t(strain.lengths.size());
  py::array_t<double> ways({size, py::ssize_t(3)});
  for (py::ssize_t v = 0; v < size; ++v)
    for (py::ssize_t a = 0; a < 3; ++a) ways.mutable_at(v, a) = strain.ways[std::size_t(v)][a];
  py::dict d;
  d["lengths"] = py::array_t<double>(size, strain.lengths.data());
  d["ways"] = ways;
  return d;
}

}  // namespace

void bind_strain(py::module_& m) {
  m.def("strain", &strain_of_arrays, py::arg("vertices").noconvert(),
        py::arg("corners").noconvert(), py::arg("offsets").noconvert(), py::arg("options"),
        py::arg("monitor"), py::arg("progress"), "discrete_fairing.strain on plain arrays.");
}

}  // namespace fairing
