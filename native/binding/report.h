// SPDX-License-Identifier: GPL-3.0-or-later
// What the core returns, as dicts, lists and NumPy arrays: all names that the package reads stand
// in report.cpp, and docs/python/fair.md describes them.
#pragma once

#include <pybind11/pybind11.h>

#include "fairing/memory_plan.h"
#include "fairing/output.h"
#include "fairing/report.h"
#include "mesh/mend/mend.h"
#include "mesh/validate/check.h"

namespace fairing {

// Needs Python's lock; the arrays move without a copy.
pybind11::dict to_python(const Report& report);
// Adds what a report says of the mesh alone: "sheets", "warnings", "repairs", "flipped_faces".
void add_mesh_report(pybind11::dict& to, const Report& report);
pybind11::dict to_python(const RunSize& size);
pybind11::list to_python(const Defects& defects);
// The arguments of the package's fairing_error().
pybind11::dict to_python(const FairingError& error);

// What was faired in the place of the input: the arrays that discrete_fairing.result.Mended has, but
// for those of refined faces.
pybind11::object to_python(const MendedMesh* mended);

// Adds "triangles" (T, 3), "quads" (Q, 4), "triangle_polygon" (T,), "quad_polygon" (Q,) and
// "crease_edges" (k, 2), all int32, to `to`;
// where something was mended "triangle_mended" (T,) and "quad_mended" (Q,) too.
void add_faces(pybind11::dict& to, OutputFaces&& faces, Array<std::int32_t>&& crease_edges);

}  // namespace fairing
