// SPDX-License-Identifier: GPL-3.0-or-later
// Sheets: the parts of a mesh that is cut along its non-manifold edges, those of three and more
// faces, and at its non-manifold vertices, where fans of faces touch in a point. Each is a manifold
// with its own vertices and edges; copies remember their originals. Feature curves and regions
// treat copies as one, so sheets share the points where they meet. A one-sided sheet is replaced by
// its double cover (mesh/double_cover.h), whose second half consists of copies too.
#pragma once

#include <algorithm>
#include <utility>
#include <vector>

#include "mesh/control_mesh.h"
#include "mesh/double_cover.h"

namespace fairing {

struct SheetCopies {
  std::vector<Index> vertex;         // the originals of the vertices after the input's, ascending
  std::vector<std::uint8_t> second;  // per copy: it is in the second half of a double cover
  DoubleCover cover;
};

// Gives every fan of faces around a vertex its own vertex: the first keeps the vertex, copies for
// the others follow all vertices. So do the second vertices of one-sided sheets, which have no
// faces yet. `mesh` must have passed check().
SheetCopies cut_into_sheets(OwnedPolygonMesh& mesh);

// Fills copies.edge of a mesh whose copied vertices, edges, sides and spokes are complete: copies
// are the last edges, with the direction of their originals.
void find_copied_edges(ControlMesh& control);

// Groups of control vertices that are one along copied edges: the fans of a vertex that share a
// non-manifold edge, and both vertices of a double cover. Fans that only touch stay apart.
class JoinedVertices {
 public:
  // `control` with its copied edges.
  explicit JoinedVertices(const ControlMesh& control);

  // The least vertex of the group of v.
  Index first(Index v) const { return first_.empty() ? v : first_[v]; }
  // visit(w) for v = first(v) and all others of its group.
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

// The connected parts of a control mesh. A vertex without faces has its own number.
struct SheetNumbers {
  std::vector<Index> of_vertex;
  Index count = 0;  // number of parts that have faces
};
SheetNumbers number_sheets(const ControlMesh& control);

}  // namespace fairing
