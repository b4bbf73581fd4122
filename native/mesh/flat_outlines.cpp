// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/flat_outlines.h"

#include <vector>

#include "mesh/chains.h"
#include "mesh/opposite.h"
#include "mesh/sharp_turn.h"

namespace fairing {
namespace {

class Outlines {
 public:
  Outlines(std::span<const std::uint8_t> flat, ControlMesh& control)
      : flat_(flat), control_(control), chains_(control) {}

  void collect() {
    for (Index e = 0; e < control_.first_copied_edge(); ++e) chains_.on[e] = is_outline(e);
    for (Index v = 0; v < control_.vertex_count(); ++v)
      chains_.corner[v] = chains_.joined.first(v) == v && is_corner(v, chains_.at(v));
    chains_.collect();
  }

 private:
  bool is_flat(Index e, std::size_t h) const { return flat_[control_.face_beside(e, h)]; }

  bool is_outline(Index e) const {
    return !control_.edges[e].boundary() && !control_.feature_edge[e] && !control_.shared_edge(e) &&
           is_flat(e, 0) != is_flat(e, 1);
  }

  FacePlane plane(Index e, std::size_t h) const {
    return plane_of(control_.faces[control_.face_beside(e, h)], control_.positions);
  }

  // Whether an edge off the flats may fold.
  bool folds(Index e) const {
    if (control_.edges[e].boundary()) return true;
    return !is_flat(e, 0) && !is_flat(e, 1) && !in_one_plane(plane(e, 0), plane(e, 1));
  }

  bool is_corner(Index v, const std::vector<Index>& edges) const {
    if (edges.size() != 2 || control_.shared(v)) return true;
    int count = 0;
    for (const Spoke& spoke : control_.ring(v)) count += folds(spoke.edge);
    const Vec3& here = control_.positions[v];
    const Vec3 in = here - control_.positions[chains_.across(edges[0], v)],
               out = control_.positions[chains_.across(edges[1], v)] - here;
    return count > 1 || in.dot(out) < sharp_turn * in.norm() * out.norm();
  }

  std::span<const std::uint8_t> flat_;
  ControlMesh& control_;
  ChainFinder chains_;
};

}  // namespace

void add_flat_outlines(std::span<const std::uint8_t> flat, ControlMesh& control) {
  Outlines(flat, control).collect();
}

}  // namespace fairing
