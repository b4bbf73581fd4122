// SPDX-License-Identifier: GPL-3.0-or-later
// Constructors that report a lack of memory as an error. pybind11 registers an instance from
// py::init outside of its own guard, and an exception there ends the process.
#pragma once

#include <pybind11/pybind11.h>

#include <memory>
#include <utility>

namespace fairing {

// As to.def(py::init<Args...>(), extra...), but translates errors of the registration too.
template <class... Args, class Class, class... Extra>
void define_constructor(pybind11::class_<Class>& to, const Extra&... extra) {
  const auto construct = [](pybind11::detail::value_and_holder& instance, Args... args) {
    auto made = std::make_unique<Class>(std::forward<Args>(args)...);
    instance.value_ptr() = made.get();
    try {
      instance.type->init_instance(instance.inst, nullptr);
    } catch (...) {
      instance.value_ptr() = nullptr;  // Python no longer refers to it
      throw;
    }
    static_cast<void>(made.release());  // the instance owns it from here on
  };
  to.def("__init__", construct, pybind11::detail::is_new_style_constructor(), extra...);
}

}  // namespace fairing
