// SPDX-License-Identifier: GPL-3.0-or-later
// The one-rings of a level's points, written out: what rows of sparse matrices are summed from.
#pragma once

#include <functional>

#include "lattice/accumulate.h"

namespace fairing {

// How many lattice steps an interior point is from the nearest side of its face.
constexpr int steps_to_side(bool quad, int n, int i, int j) {
  return quad ? std::min(std::min(i, j), std::min(n - i, n - j)) : std::min(std::min(i, j), n - i - j);
}

// One a point of the level.
std::vector<std::uint8_t> unknown_points(const Lattice& lattice, const Unknowns& unknowns);

class WrittenRings {
 public:
  // Of control vertices, edges, and the points inside face f at most steps(f) from its sides.
  WrittenRings(const Lattice& lattice, const Unknowns& unknowns, const std::function<int(Index)>& steps,
               Workers& workers);

  // The id of a point, or ~id where it is no unknown.
  using Member = Index;
  static constexpr Index id_of(Member m) { return m < 0 ? ~m : m; }

  struct Ring {
    std::size_t
        member;  // the first of `size`: the point itself, then its neighbours in the order of its chart
    std::uint32_t size;
    Index element;  // control vertex, V + edge, or V + E + face
  };
  // The ring about a point; null where it is not written.
  const Ring* about(Index p) const {
    const Index r = std::size_t(p) < first_in_faces_ ? p : ring_of_[std::size_t(p) - first_in_faces_];
    return r < 0 ? nullptr : &ring_[std::size_t(r)];
  }
  std::size_t number(const Ring& ring) const { return std::size_t(&ring - ring_.data()); }
  std::size_t count() const { return ring_.size(); }
  const Member* members(const Ring& ring) const { return member_.data() + ring.member; }
  // The place of a point among the members; their number where it is none.
  std::size_t slot(const Ring& ring, Index p) const {
    const Member* const member = members(ring);
    std::size_t s = 0;
    while (s < ring.size && id_of(member[s]) != p) ++s;
    return s;
  }
  const Array<Member>& coded() const { return coded_; }  // every point
  bool is_unknown(Index p) const { return coded_[std::size_t(p)] >= 0; }

 private:
  void code_points(const Unknowns& unknowns);
  void write_vertices();
  void write_edges(Workers& workers);
  void write_faces(const std::function<int(Index)>& steps, Workers& workers);

  const Lattice& lattice_;
  std::size_t first_in_faces_;
  Array<Member> coded_;
  Array<Index> ring_of_;  // of the points inside faces; -1: not written
  Array<Ring> ring_;
  Array<Member> member_;
};

}  // namespace fairing
