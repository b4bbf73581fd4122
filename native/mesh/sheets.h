// SPDX-License-Identifier: GPL-3.0-or-later
// Sheets: what is left of a mesh when it is cut apart along its non-manifold edges, those of three
// and more faces, and at its non-manifold vertices, where fans of faces touch in a point. Each is a
// manifold, with vertices and edges of its own; copies remember what they are copies of. Feature
// curves and regions see the copies as one, so that sheets share the points where they meet. A sheet
// with only one side is replaced by its double cover (mesh/double_cover.h), whose second half is made
// of copies too.
#pragma once

#include <algorithm>
#include <utility>
#include <vector>

#include "mesh/control_mesh.h"
#include "mesh/double_cover.h"

namespace fairing {

struct SheetCopies {
  std::vector<Index> vertex;  // what the vertices behind the input's are copies of, ascending
  std::vector<std::uint8_t> second;  // of these: those over another one, on a double cover
  DoubleCover cover;
};

// Gives every fan of faces around a vertex a vertex of its own: the first keeps the vertex, copies
// for the others are added behind all vertices. So are vertices over those of one-sided sheets; no
// face has these yet. `mesh` must have passed check().
SheetCopies cut_into_sheets(OwnedPolygonMesh& mesh);
// How many vertices that adds. No face may have a vertex twice.
std::size_t count_copies(const PolygonMesh& mesh, const HalfEdges& half_edges,
                         const DoubleCover& cover);

// Fills copies.edge of a mesh whose copied vertices, edges, sides and spokes are complete: copies
// become the last edges and run as their originals do.
void find_copied_edges(ControlMesh& control);

// Control vertices that are one along copied edges: the fans of a vertex that non-manifold edges
// join, and both at a place of a double cover. Fans that only touch stay apart.
class JoinedVertices {
 public:
  // `control` with its copied edges.
  explicit JoinedVertices(const ControlMesh& control);

  // The least of those that are one with v.
  Index first(Index v) const { return first_.empty() ? v : first_[std::size_t(v)]; }
  // visit(w) for v = first(v) and all that are one with it.
  template <class Visit>
  void for_each(Index v, Visit&& visit) const {
    visit(v);
    auto other = std::lower_bound(others_.begin(), others_.end(), std::pair(v, Index(0)));
    for (; other != others_.end() && other->first == v; ++other) visit(other->second);
  }

 private:
  std::vector<Index> first_;                     // empty: all apart
  std::vector<std::pair<Index, Index>> others_;  // first and another, ascending
};

// The parts of a control mesh that hang together. A vertex without faces has a number of its own.
struct SheetNumbers {
  std::vector<Index> of_vertex;
  Index count = 0;  // of those that have faces
};
SheetNumbers number_sheets(const ControlMesh& control);

}  // namespace fairing
