// SPDX-License-Identifier: GPL-3.0-or-later
// Chains of flagged edges: of features, and of outlines of given flats.
#pragma once

#include <vector>

#include "mesh/control_mesh.h"
#include "mesh/sheets.h"

namespace fairing {

// Flagged edges of a mesh, seen from the first of joined vertices; edges and vertices without copies.
class ChainFinder {
 public:
  std::vector<std::uint8_t> on;      // one an edge; copies have the flags of their originals
  std::vector<std::uint8_t> corner;  // one a vertex: chains end there
  const JoinedVertices joined;

  explicit ChainFinder(ControlMesh& control);

  // The flagged edges at v; valid until the next call.
  const std::vector<Index>& at(Index v);
  // The other end of an edge at v.
  Index across(Index e, Index v) const;

  // Adds the chains to the mesh's, and clears all flags of their edges. At a vertex that is no
  // corner two of them meet, or none.
  void collect();

 private:
  void collect_from(Index start, Index e);

  ControlMesh& control_;
  std::vector<Index> found_;
};

}  // namespace fairing
