// SPDX-License-Identifier: GPL-3.0-or-later
// The driver: plain arrays in, fair surface and report out.
#pragma once

#include "check/polygon_mesh.h"
#include "execution/memory.h"
#include "execution/monitor.h"
#include "fair/options.h"
#include "fair/report.h"

namespace fairing {

struct FairResult {
  Array<double> vertices;                // 3 a point; the input's vertices first
  std::vector<Array<double>> shapes;     // the same of every shape
  Array<std::int32_t> triangles;         // 3 a triangle: of the control triangles' lattices
  Array<std::int32_t> quads;             // 4 a quad: of the control quads' lattices
  Array<std::int32_t> triangle_polygon;  // the input face that each comes from
  Array<std::int32_t> quad_polygon;
  Array<std::int32_t> crease_edges;  // 2 an edge: the control edges that became creases, by whatever rule
  Report report;
};

// Throws FairingError and nothing else. The arrays of `mesh` are only read. May run on any thread; `monitor` is
// watched from others.
FairResult fair(const PolygonMesh& mesh, const FairOptions& options, Monitor& monitor);

}  // namespace fairing
