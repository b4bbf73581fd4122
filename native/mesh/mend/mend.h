// SPDX-License-Identifier: GPL-3.0-or-later
// Mends a mesh before check(): repeated and coincident corners, duplicate faces, faces without
// area, faces with missing vertices. It does not change sheets or orientation. The input is only
// read.
//
// Deterministic, and independent of the order of faces and corners except for ties, which the
// lowest id decides. Linear time up to sorting. May throw FairingError(cancelled) and
// std::bad_alloc.
#pragma once

#include <algorithm>
#include <array>
#include <string>
#include <vector>

#include "base/error.h"
#include "base/types.h"
#include "mesh/polygon_mesh.h"

namespace fairing {

struct MendOptions {
  // Merges vertices no farther apart than this: 0 those at one point, negative none.
  double weld = -1;
};

// The origin of a corner's values: (1 - share) of input corner `from` and `share` of `beside`.
struct CornerOrigin {
  Index from, beside;
  double share = 0;
};

// An edge of the input (low < high) with inserted vertices, in order from low.
struct CutEdge {
  Index low, high;
  std::vector<Index> between;
};

struct MendedMesh {
  // Whether anything was mended; if not, all that follows is empty.
  bool changed() const { return !acts.empty(); }

  // As many vertices as the input, in its order. A vertex that was merged, or has neither a finite
  // position nor a face, is at the place of its `vertex_origin` and has no face.
  OwnedPolygonMesh mesh;
  std::vector<Index> vertex_origin;  // usually the vertex itself
  std::vector<Index> face_origin;    // the input face of every face, ascending
  std::vector<CornerOrigin> corner_origin;
  std::vector<CutEdge> cut_edges;  // ascending

  // The repairs, each with all elements of the input concerned.
  std::vector<Warning> acts;

  std::size_t bytes() const;

  // Other positions of the input's vertices, 3 numbers each, with merged vertices moved along.
  std::vector<double> placed(std::span<const double> coordinates) const;
};

// Gives merged vertices the values of those at their origin; `values` may be empty.
template <class T>
void give_to_merged(const std::vector<Index>& origin, std::vector<T>& values) {
  for (std::size_t v = 0; v < std::min(origin.size(), values.size()); ++v)
    values[v] = values[origin[v]];
}

// Throws the first defect that prevents mending.
void require_mendable(const PolygonMesh& mesh);

// Throws FairingError for defects that cannot be mended: invalid arrays, vertices of faces without
// a finite position, no face left.
MendedMesh mend(const PolygonMesh& mesh, const MendOptions& options = {});

}  // namespace fairing
