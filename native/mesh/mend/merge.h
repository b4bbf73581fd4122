// SPDX-License-Identifier: GPL-3.0-or-later
// Which vertices become one. For mesh/mend/ only.
#pragma once

#include <vector>

#include "base/types.h"
#include "mesh/polygon_mesh.h"
#include "parallel/memory.h"

namespace fairing {

// Groups of vertices that are one, each led by its lowest.
class Merges {
 public:
  explicit Merges(std::size_t vertices);

  Index lead(Index v) {
    for (;;) {
      Index& above = lead_[std::size_t(v)];
      if (above == v) return v;
      above = lead_[std::size_t(above)];  // so that ways stay short
      v = above;
    }
  }
  void unite(Index a, Index b);
  bool any() const { return any_; }

 private:
  Array<Index> lead_;
  bool any_ = false;
};

// Unites vertices of faces no farther apart than `distance`: each, by its id, with the lowest that
// is kept and near enough. So none moves farther than that.
void weld(const PolygonMesh& mesh, double distance, Merges& merges);

// Unites vertices of a face at one point, and the ends of a side that is next to nothing in a face
// without area. `mesh` has finite vertices in its faces.
void merge_within_faces(const PolygonMesh& mesh, Merges& merges);

}  // namespace fairing
