// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <pybind11/pybind11.h>

namespace fairing {

// Adds the class Solver, which the package wraps.
void bind_solver(pybind11::module_& m);

}  // namespace fairing
