// SPDX-License-Identifier: GPL-3.0-or-later
// What a mesh has that takes memory, counted before a run: elements, which of them are unknowns, and
// what their shapes will make of the solver.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "grid/accumulate.h"
#include "grid/grid_level.h"
#include "mesh/control_mesh.h"

namespace fairing {

// Of control faces that are all triangles and quads.
struct Counts {
  std::int64_t vertices = 0, edges = 0, triangles = 0, quads = 0;
  // Of these, where sheets meet or have only one side.
  std::int64_t copied_vertices = 0, copied_edges = 0, copied_triangles = 0, copied_quads = 0;
  std::int64_t lone = 0;  // vertices without a face, as merged ones: no unknowns ever
  // Those whose points are unknowns.
  std::int64_t free_vertices = 0, free_edges = 0, free_triangles = 0, free_quads = 0;
  // Where many faces meet at a vertex, each of its neighbours has a row with all others.
  std::int64_t in_large_rings = 0;
  // Faces of each part that edges of unknowns connect: a factor is one of each.
  std::vector<std::int64_t> parts{};
  bool thin = false;  // many thin faces: rows have few numbers in common

  std::int64_t faces() const { return triangles + quads; }
  std::int64_t welded_triangles() const { return triangles - copied_triangles; }
  std::int64_t welded_quads() const { return quads - copied_quads; }
  std::int64_t sides() const { return 3 * triangles + 4 * quads; }
  // Points of the surface after so many refinements.
  std::int64_t points(int level) const {
    return grid_size(vertices, edges, triangles, quads, level);
  }
  std::int64_t welded_points(int level) const {
    return grid_size(vertices - copied_vertices, edges - copied_edges, welded_triangles(),
                     welded_quads(), level);
  }
  std::int64_t used_points(int level) const { return points(level) - lone; }
  std::int64_t unknowns(int level) const {
    return grid_size(free_vertices, free_edges, free_triangles, free_quads, level);
  }
  // The coarsest level that is solved: vertices that are fixed have nothing to solve for.
  int base(int levels) const { return free_vertices > 0 || levels == 0 ? 0 : 1; }
};

// From the number of vertices and from faces that require_faces() lets pass: polygons as if split
// around a centre, borders and edges of more than two faces fixed, shapes unknown.
Counts count_elements(std::int64_t vertices, std::span<const std::int64_t> corners,
                      std::span<const std::int64_t> offsets);
Counts count_elements(const ControlMesh& mesh, const Unknowns& unknowns);

}  // namespace fairing
