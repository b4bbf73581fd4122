// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/flat_outlines.h"

#include <utility>
#include <vector>

#include "mesh/opposite.h"
#include "mesh/sharp_turn.h"

namespace fairing {
namespace {

class Outlines {
 public:
  Outlines(std::span<const std::uint8_t> flat, ControlMesh& control)
      : flat_(flat),
        control_(control),
        edges_(std::size_t(control.vertex_count())),
        seen_(control.edges.size(), 0) {
    for (Index e = 0; e < control_.first_copied_edge(); ++e)
      if (is_outline(e))
        for (const Index v : control_.edges[e].vertex) edges_[v].push_back(e);
  }

  void collect() {
    for (const bool corners : {true, false})  // the rest is closed
      for (Index v = 0; v < control_.vertex_count(); ++v)
        if (is_corner(v) == corners)
          for (const Index e : edges_[v]) collect_chain(v, e);
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

  Index across(Index e, Index v) const {
    const auto& ends = control_.edges[e].vertex;
    return ends[ends[0] == v];
  }

  bool is_corner(Index v) const {
    if (edges_[v].size() != 2 || control_.shared(v)) return true;
    int count = 0;
    for (const Spoke& spoke : control_.ring(v)) count += folds(spoke.edge);
    const Vec3& here = control_.positions[v];
    const Vec3 in = here - control_.positions[across(edges_[v][0], v)],
               out = control_.positions[across(edges_[v][1], v)] - here;
    return count > 1 || in.dot(out) < sharp_turn * in.norm() * out.norm();
  }

  void collect_chain(Index start, Index e) {
    if (seen_[e]) return;
    Chain chain;
    chain.vertices.push_back(start);
    for (Index v = start;;) {
      seen_[e] = 1;
      chain.edges.push_back(e);
      v = across(e, v);
      if (is_corner(v)) {
        chain.vertices.push_back(v);
        break;
      }
      if (v == start) {
        chain.closed = true;
        break;
      }
      chain.vertices.push_back(v);
      e = edges_[v][edges_[v][0] == e];
    }
    control_.chains.push_back(std::move(chain));
  }

  std::span<const std::uint8_t> flat_;
  ControlMesh& control_;
  std::vector<std::vector<Index>> edges_;  // of outlines, by vertex
  std::vector<std::uint8_t> seen_;         // by edge
};

}  // namespace

void add_flat_outlines(std::span<const std::uint8_t> flat, ControlMesh& control) {
  Outlines(flat, control).collect();
}

}  // namespace fairing
