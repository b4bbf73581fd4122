// SPDX-License-Identifier: GPL-3.0-or-later
// Faces during mend(): corners with their origin. For mesh/mend/, and for the walks around holes
// (mesh/fill/holes.cpp), whose corners have no origin.
#pragma once

#include <span>
#include <vector>

#include "mesh/mend/mend.h"
#include "parallel/memory.h"

namespace fairing {

struct MendCorner {
  Index vertex;
  CornerOrigin origin;
};

using Loop = std::vector<MendCorner>;

inline std::vector<Index> vertices_of(std::span<const MendCorner> loop) {
  std::vector<Index> vertices;
  for (const MendCorner& corner : loop) vertices.push_back(corner.vertex);
  return vertices;
}

// Faces, one after another, each with its input face.
struct Loops {
  Array<MendCorner> corners;
  Array<Index> offsets{0};
  Array<Index> origin;

  Index count() const { return Index(origin.size()); }
  // For so many faces and corners in total.
  void reserve(std::size_t faces, std::size_t count) {
    corners.reserve(count);
    offsets.reserve(faces + 1);
    origin.reserve(faces);
  }
  std::span<const MendCorner> face(Index f) const {
    return {corners.data() + offsets[f], corners.data() + offsets[std::size_t(f) + 1]};
  }
  void add(std::span<const MendCorner> loop, Index from) {
    corners.insert(corners.end(), loop.begin(), loop.end());
    offsets.push_back(Index(corners.size()));
    origin.push_back(from);
  }
};

// The loops of three corners and more of a closed walk, none with a vertex twice: repeated corners
// and spikes are removed, and the walk is cut where it meets a vertex again.
std::vector<Loop> simple_loops(std::span<const MendCorner> walk);

// The faces' arrays as check() reads them.
OwnedPolygonMesh to_arrays(const Loops& loops, std::vector<double> coordinates);

}  // namespace fairing
