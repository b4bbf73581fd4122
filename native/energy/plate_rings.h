// SPDX-License-Identifier: GPL-3.0-or-later
// The divided differences of the thin plate on one level, written out with their points: what rows of K are summed from.
#pragma once

#include <algorithm>

#include "energy/joint_weight.h"
#include "energy/thin_plate.h"

namespace fairing {

// How many lattice steps an interior point is from the nearest side of its face.
constexpr int steps_to_side(bool quad, int n, int i, int j) {
  return quad ? std::min(std::min(i, j), std::min(n - i, n - j)) : std::min(std::min(i, j), n - i - j);
}

class PlateRings {
 public:
  // Of control vertices, edges, and the points inside faces at most so many steps from a side; of all points in faces
  // whose points are weighted one by one.
  PlateRings(const Lattice& lattice, const Stencils& stencils, const Unknowns& unknowns, int steps,
             Workers& workers);

  // The id of a point, or ~id where it is no unknown.
  using Member = Index;
  static constexpr Index id_of(Member m) { return m < 0 ? ~m : m; }

  struct Ring {
    std::size_t member = 0,
                gram = 0;    // the first of `size` members, the centre; the first of size x size numbers
    std::uint32_t size = 0;  // 0: no fit
    float weight = 1;
  };
  // The ring about a point; null where there is no fit, or it is not written.
  const Ring* about(Index p) const {
    const Index r = std::size_t(p) < first_in_faces_ ? p : ring_of_[std::size_t(p) - first_in_faces_];
    return r < 0 || ring_[std::size_t(r)].size == 0 ? nullptr : &ring_[std::size_t(r)];
  }
  const Member* members(const Ring& ring) const { return member_.data() + ring.member; }
  // Row s of J^T J: what a unit at member s does to half the energy's gradient at all members.
  const double* row(const Ring& ring, std::size_t s) const {
    return gram_.data() + ring.gram + s * ring.size;
  }
  bool is_unknown(Index p) const { return coded_[std::size_t(p)] >= 0; }

 private:
  void code_points(const Unknowns& unknowns);
  void write_vertices(const Stencils& stencils);
  void write_edges(const Stencils& stencils, Workers& workers);
  void write_faces(const Stencils& stencils, int steps, Workers& workers);

  const Lattice& lattice_;
  JointWeight joint_;
  std::size_t first_in_faces_;
  Array<Member> coded_;   // every point
  Array<Index> ring_of_;  // of the points inside faces; -1: not written
  Array<Ring> ring_;
  Array<Member> member_;
  Array<double> gram_;  // one matrix a vertex, edge and face
};

}  // namespace fairing
