// SPDX-License-Identifier: GPL-3.0-or-later
// The parts of the module _native; module.cpp calls them.
#pragma once

#include <pybind11/pybind11.h>

#include "fairing/whole.h"

namespace fairing {

// Adds the class Options, with one attribute for each setting, and the enums of choices.
void bind_options(pybind11::module_& m);

// Adds the class Solver, which the package wraps.
void bind_solver(pybind11::module_& m);

// Adds the class Filler, which the package's find_holes() and fill_holes() use.
void bind_fill(pybind11::module_& m);

// Adds mended(), to_flip() and joined(), which the package's clean() uses.
void bind_clean(pybind11::module_& m);

// Adds border_fits() and damped_solution(), which the package's joints/ use.
void bind_joints(pybind11::module_& m);

// Adds strain() and ease(), which the package wraps.
void bind_strain(pybind11::module_& m);

// Adds fit(), which the package wraps.
void bind_fit(pybind11::module_& m);

// Adds outline(), which the package's pieces() cuts.
void bind_outline(pybind11::module_& m);
// The data of a piece from its whole: a dict of the package's, or None.
OfWhole whole_from(const pybind11::object& given);

// Adds fit_splines() for the package's fit_patches(), and the members of Monitor that it needs.
void bind_splines(pybind11::module_& m);

}  // namespace fairing
