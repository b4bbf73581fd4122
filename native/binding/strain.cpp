// SPDX-License-Identifier: GPL-3.0-or-later
#include "strain/strain.h"

#include "binding/arrays.h"
#include "binding/bindings.h"
#include "binding/runner.h"
#include "strain/ease.h"

namespace py = pybind11;

namespace fairing {
namespace {

py::array_t<double> numbers(const std::vector<double>& values) {
  return py::array_t<double>(py::ssize_t(values.size()), values.data());
}

py::array_t<double> points(const std::vector<Vec3>& values) {
  py::array_t<double> out({py::ssize_t(values.size()), py::ssize_t(3)});
  for (std::size_t v = 0; v < values.size(); ++v)
    for (py::ssize_t a = 0; a < 3; ++a) out.mutable_at(py::ssize_t(v), a) = values[v][a];
  return out;
}

py::array_t<std::uint8_t> flags(const std::vector<std::uint8_t>& values) {
  return py::array_t<std::uint8_t>(py::ssize_t(values.size()), values.data());
}

py::dict strain_of_arrays(const Contiguous<double>& vertices,
                          const Contiguous<std::int64_t>& corners,
                          const Contiguous<std::int64_t>& offsets, const FairOptions& options,
                          Monitor& monitor, const py::object& progress) {
  const OwnedPolygonMesh mesh = copy_of(vertices, corners, offsets);
  const FairOptions own = options;
  Strain strain;
  Runner().run([&] { strain = measure_strain(mesh.view(), own, monitor); }, monitor, nullptr,
               progress);
  py::dict d;
  d["lengths"] = numbers(strain.all.lengths);
  d["ways"] = points(strain.all.ways);
  d["excess"] = numbers(strain.excess.own.lengths);
  d["excess_ways"] = points(strain.excess.own.ways);
  d["floor"] = strain.excess.floor;
  d["wrong"] = flags(strain.excess.wrong);
  d["on_curve"] = flags(strain.on_curve);
  return d;
}

py::dict ease_arrays(const Contiguous<double>& vertices, const Contiguous<std::int64_t>& corners,
                     const Contiguous<std::int64_t>& offsets, const Contiguous<double>& tolerance,
                     double amount, int most, const Contiguous<std::uint8_t>& fixed,
                     const FairOptions& options, Monitor& monitor, const py::object& progress) {
  const OwnedPolygonMesh mesh = copy_of(vertices, corners, offsets);
  const std::vector<double> bounds = copy_of(tolerance);
  const std::vector<std::uint8_t> stays = copy_of(fixed);
  const FairOptions own = options;
  EaseResult result;
  Runner().run(
      [&] { result = ease_control_mesh(mesh.view(), own, {bounds, amount, most, stays}, monitor); },
      monitor, nullptr, progress);
  py::dict d;
  d["moves"] = points(result.moves);
  d["strain_before"] = numbers(result.before.own.lengths);
  d["strain_after"] = numbers(result.after.own.lengths);
  d["floor"] = result.before.floor;
  d["wrong"] = flags(result.before.wrong);
  d["amount"] = result.amount;
  d["noise"] = result.noise;
  d["iterations"] = result.iterations;
  return d;
}

}  // namespace

void bind_strain(py::module_& m) {
  m.def("strain", &strain_of_arrays, py::arg("vertices").noconvert(),
        py::arg("corners").noconvert(), py::arg("offsets").noconvert(), py::arg("options"),
        py::arg("monitor"), py::arg("progress"), "discrete_fairing.strain on plain arrays.");
  m.def("ease", &ease_arrays, py::arg("vertices").noconvert(), py::arg("corners").noconvert(),
        py::arg("offsets").noconvert(), py::arg("tolerance").noconvert(), py::arg("amount"),
        py::arg("most"), py::arg("fixed").noconvert(), py::arg("options"), py::arg("monitor"),
        py::arg("progress"), "discrete_fairing.ease on plain arrays.");
}

}  // namespace fairing
