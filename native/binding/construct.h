// SPDX-License-Identifier: GPL-3.0-or-later
// Constructors that fail in words where memory is out. pybind11 registers an instance that py::init
// has made outside of what it guards: what is thrown there ends the process.
#pragma once

#include <pybind11/pybind11.h>

#include <memory>
#include <utility>

namespace fairing {

// As to.def(py::init<Args...>(), extra...), registering included in what errors are translated of.
template <class... Args, class Class, class... Extra>
void define_constructor(pybind11::class_<Class>& to, const Extra&... extra) {
  const auto construct = [](pybind11::detail::value_and_holder& instance, Args... args) {
    auto made = std::make_unique<Class>(std::forward<Args>(args)...);
    instance.value_ptr() = made.get();
    try {
      instance.type->init_instance(instance.inst, nullptr);
    } catch (...) {
      instance.value_ptr() = nullptr;  // nothing of it is left to Python
      throw;
    }
    static_cast<void>(made.release());  // the instance's own from here on
  };
  to.def("__init__", construct, pybind11::detail::is_new_style_constructor(), extra...);
}

}  // namespace fairing
