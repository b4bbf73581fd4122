// SPDX-License-Identifier: GPL-3.0-or-later
// Which faces meet at each edge, in any orientation: the basis of all topology checks. Unlike
// OpenMesh it accepts any set of faces. Linear time, by a counting sort.
#pragma once

#include <cstdint>
#include <vector>

#include "mesh/polygon_mesh.h"

namespace fairing {

// Half-edge k runs from corners[k] to the next corner of the same face.
class HalfEdges {
 public:
  // The arrays must have passed check_arrays, and must outlive this.
  explicit HalfEdges(const PolygonMesh& mesh);

  std::int32_t count() const { return std::int32_t(face_.size()); }
  std::int32_t face(std::int32_t k) const { return face_[k]; }
  std::int64_t from(std::int32_t k) const { return mesh_.corners[k]; }
  std::int32_t next(std::int32_t k) const;
  std::int32_t previous(std::int32_t k) const;

  // The other half-edge of the edge; -1 on the boundary and where more than two faces meet.
  std::int32_t twin(std::int32_t k) const { return twin_[k]; }
  bool runs_as_twin(std::int32_t k) const { return from(k) == from(twin(k)); }

  // visit(corner, turned) for the corners of the fan around from(k) that contains corner k, which
  // comes first, in any orientation. `turned`: the corner's face runs against that of k.
  template <class Visit>
  void visit_fan(std::int32_t k, Visit&& visit) const {
    const std::int64_t v = from(k);
    visit(k, false);
    for (std::int32_t exit : {k, previous(k)}) {
      bool turned = false;
      for (std::int32_t t = twin(exit); t >= 0; t = twin(exit)) {
        turned ^= runs_as_twin(exit);
        const bool outgoing = from(t) == v;
        const std::int32_t corner = outgoing ? t : next(t);
        if (corner == k) return;  // once around
        visit(corner, turned);
        exit = outgoing ? previous(t) : corner;
      }
    }
  }

  // Vertex pairs of the edges with more than two faces, one after another.
  const std::vector<std::int64_t>& nonmanifold_edges() const { return nonmanifold_edges_; }
  std::int64_t sides_at_nonmanifold_edges() const { return nonmanifold_sides_; }

 private:
  void find_twins();

  PolygonMesh mesh_;
  std::vector<std::int32_t> face_, twin_;
  std::vector<std::int64_t> nonmanifold_edges_;
  std::int64_t nonmanifold_sides_ = 0;
};

}  // namespace fairing
