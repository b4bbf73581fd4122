// SPDX-License-Identifier: GPL-3.0-or-later
// FairOptions in Python: flat, one attribute for each setting, named like fair()'s keywords. The
// package converts the callers' values (discrete_fairing/options.py); here types are exact.
#include "fairing/settings.h"

#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <utility>

#include "binding/bindings.h"
#include "binding/construct.h"

namespace py = pybind11;

namespace fairing {
namespace {

void bind_choices(py::module_& m) {
  py::enum_<BoundaryMode>(m, "Boundary")
      .value("curve", BoundaryMode::curve)
      .value("linear", BoundaryMode::linear)
      .value("free", BoundaryMode::free);
  py::enum_<RegionContinuity>(m, "RegionContinuity")
      .value("position", RegionContinuity::position)
      .value("tangent", RegionContinuity::tangent)
      .value("curvature", RegionContinuity::curvature);
  py::enum_<ChartKind>(m, "Chart")
      .value("exponential", ChartKind::exponential)
      .value("tangent", ChartKind::tangent);
  py::enum_<Interpolation>(m, "Interpolation")
      .value("exact", Interpolation::exact)
      .value("approximate", Interpolation::approximate)
      .value("limit", Interpolation::limit);
  py::enum_<Energy>(m, "Energy")
      .value("thin_plate", Energy::thin_plate)
      .value("total_curvature", Energy::total_curvature)
      .value("minimum_variation", Energy::minimum_variation);
  py::enum_<Repair>(m, "Repair").value("refuse", Repair::refuse).value("mend", Repair::mend);
  py::enum_<Method>(m, "Method")
      .value("multigrid", Method::multigrid)
      .value("back_leg", Method::back_leg);
}

// Adds a setting: a member of FairOptions or of a part of it.
template <class... Member>
void bind_setting(py::class_<FairOptions>& options, const char* name, Member... member) {
  using Value = std::remove_cvref_t<decltype((std::declval<FairOptions&>().*....*member))>;
  options.def_property(
      name, [=](const FairOptions& o) -> Value { return (o.*....*member); },
      [=](FairOptions& o, Value value) { (o.*....*member) = std::move(value); });
}

}  // namespace

void bind_options(py::module_& m) {
  bind_choices(m);
  m.attr("most_levels") = most_levels;
  py::class_<FairOptions> options(m, "Options", "All settings; new ones hold the defaults.");
  define_constructor(options);
  for_each_setting([&](const char* name, const auto&, auto... member) {
    bind_setting(options, name, member...);
  });
  // Setting it defines a region, which may be empty.
  options.def_property(
      "region", [](const FairOptions& o) { return o.features.region.faces; },
      [](FairOptions& o, std::vector<std::int64_t> faces) {
        o.features.region.given = true;
        o.features.region.faces = std::move(faces);
      });
}

}  // namespace fairing
