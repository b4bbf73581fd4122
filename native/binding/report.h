// SPDX-License-Identifier: GPL-3.0-or-later
// Results of the core as dicts, lists and NumPy arrays. The names that the package reads are in
// report.cpp, and documented in docs/python/fair.md.
#pragma once

#include <pybind11/pybind11.h>

#include "fairing/memory_plan.h"
#include "fairing/output.h"
#include "fairing/report.h"
#include "mesh/mend/mend.h"
#include "mesh/validate/check.h"

namespace fairing {

// Requires Python's lock; arrays are moved without a copy.
pybind11::dict to_python(const Report& report);
// Adds the part of a report about the mesh: "sheets", "warnings", "repairs", "flipped_faces".
void add_mesh_report(pybind11::dict& to, const Report& report);
pybind11::dict to_python(const RunSize& size);
pybind11::list to_python(const Defects& defects);
// The arguments of the package's fairing_error().
pybind11::dict to_python(const FairingError& error);

// The mesh that was faired in place of the input: the arrays of discrete_fairing.result.Mended,
// without those of refined faces.
pybind11::object to_python(const MendedMesh* mended);

// Adds "triangles" (T, 3), "quads" (Q, 4), "triangle_polygon" (T,), "quad_polygon" (Q,) and
// "crease_edges" (k, 2), all int32, to `to`; after mending also "triangle_mended" (T,) and
// "quad_mended" (Q,).
void add_faces(pybind11::dict& to, OutputFaces&& faces, Array<std::int32_t>&& crease_edges);

}  // namespace fairing
