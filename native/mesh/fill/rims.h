// SPDX-License-Identifier: GPL-3.0-or-later
// The mesh around its holes. For mesh/fill/ only.
#pragma once

#include <unordered_map>
#include <unordered_set>
#include <vector>

#include "mesh/fill/fill.h"

namespace fairing {

// Which vertices of rims an edge joins, and the faces behind the sides of rims.
class Rims {
 public:
  // Of all vertices in these loops; the mesh must outlive this.
  Rims(const PolygonMesh& mesh, const HalfEdges& half_edges, std::span<const Hole> holes);

  Vec3 point(std::int64_t v) const;

  // Whether an edge of the mesh or of a filling joins two vertices of rims.
  bool are_joined(std::int64_t a, std::int64_t b) const {
    return edges_.contains(key(a, b)) || filled_.contains(key(a, b));
  }

  // Adds or removes an edge of a filling.
  void join(std::int64_t a, std::int64_t b) { filled_.insert(key(a, b)); }
  void part(std::int64_t a, std::int64_t b) { filled_.erase(key(a, b)); }

  // Whether a face has the side from a to b, on the border.
  bool is_border(std::int64_t a, std::int64_t b) const { return border_.contains(side(a, b)); }

  // Unit normal of the face with that side; zero for a face without area.
  Vec3 normal_beside(std::int64_t a, std::int64_t b) const;

  // One number for the side from a to b: ids of vertices have 32 bits.
  static std::uint64_t side(std::int64_t a, std::int64_t b) {
    return std::uint64_t(a) << 32 | std::uint64_t(b);
  }

 private:
  static std::uint64_t key(std::int64_t a, std::int64_t b) {
    return a < b ? side(a, b) : side(b, a);
  }

  const PolygonMesh& mesh_;
  std::unordered_map<std::uint64_t, std::int32_t> border_;  // to the face
  std::unordered_set<std::uint64_t> edges_, filled_;        // of the mesh, of fillings
};

}  // namespace fairing
