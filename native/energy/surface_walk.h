// SPDX-License-Identifier: GPL-3.0-or-later
// The rings in space of a level's points, one after another, in memory that is taken once.
#pragma once

#include "energy/point_curvature.h"
#include "lattice/ring.h"

namespace fairing {

// One ring. `slot[j]` is where neighbour j stands in the order of the lattice (RingRows).
class RingInSpace {
 public:
  void start(const double* centre) {
    centre_ = centre;
    offset_.clear();
    far_.clear();
    slot_.clear();
  }
  void add(const double* p, bool far, int slot) {
    offset_.emplace_back(p[0] - centre_[0], p[1] - centre_[1], p[2] - centre_[2]);
    far_.push_back(far);
    slot_.push_back(slot);
  }
  SurfaceRing view(bool closed) const { return {offset_, far_, closed}; }
  const std::vector<int>& slot() const { return slot_; }

 private:
  const double* centre_ = nullptr;
  std::vector<Vec3> offset_;
  std::vector<std::uint8_t> far_;
  std::vector<int> slot_;
};

// Calls visit(i, ring, closed) for the points of an element: one of a control vertex; i = 0 … n - 2 of an edge; of a face
// visit(j, i, ring, closed), rows j = 1 …, i = 0 … in the row.
template <class Visit>
void walk_vertex(const Lattice& lattice, Index v, const double* x, RingInSpace& ring, Visit&& visit) {
  ring.start(x + 3 * std::size_t(v));
  int slot = 0;
  visit_ring(lattice, v,
             [&](Index p, std::size_t place) { ring.add(x + 3 * std::size_t(p), place % 2 == 1, ++slot); });
  visit(ring, lattice.mesh().interior(v));
}

template <class Visit>
void walk_edge(const Lattice& lattice, Index e, const double* x, std::vector<double>& scratch,
               RingInSpace& ring, Visit&& visit) {
  const EdgeRingLanes lanes_of_ring(lattice.mesh(), e);
  const EdgeLanes<double> lanes(lattice, x, e, scratch);
  const Edge& edge = lattice.mesh().edges[std::size_t(e)];
  // An open ring starts on the boundary: without a left face, behind.
  const int size = lanes_of_ring.size, start = edge.side[0] < 0 ? 1 : 0;
  for (int k = 1; k < lattice.n(); ++k) {
    ring.start(lanes.lane[0] + 3 * k);
    for (int m = 0; m < size; ++m) {
      const int j = (start + m) % size;
      ring.add(lanes.lane[lanes_of_ring.lane[j]] + 3 * (lanes_of_ring.at[j] + k), lanes_of_ring.far[j],
               j + 1);
    }
    visit(std::size_t(k - 1), ring, !edge.boundary());
  }
}

template <class Visit>
void walk_face(const Lattice& lattice, Index f, const double* x, std::vector<double>& closed,
               RingInSpace& ring, Visit&& visit) {
  const bool quad = lattice.mesh().faces[std::size_t(f)].quad();
  const int n = lattice.n();
  closed.resize(3 * closed_size(true, std::size_t(n)));
  gather_face(lattice, x, f, closed.data());
  const auto at = [&](int i, int j) {
    return closed.data() + 3 * (closed_row(quad, std::size_t(n), std::size_t(j)) + std::size_t(i));
  };
  const auto steps = face_ring(quad);
  for (int j = 1; j < n; ++j)
    for (int i = 1; i < (quad ? n : n - j); ++i) {
      ring.start(at(i, j));
      int slot = 0;
      for (const LatticePoint d : steps) ring.add(at(i + d.i, j + d.j), quad && d.i * d.j != 0, ++slot);
      visit(j, std::size_t(i - 1), ring, true);
    }
}

}  // namespace fairing
