// SPDX-License-Identifier: GPL-3.0-or-later
// The one-rings of a level's points, written out: what rows of sparse matrices are summed from.
#pragma once

#include "lattice/accumulate.h"

namespace fairing {

// One a point of the level.
std::vector<std::uint8_t> unknown_points(const Lattice& lattice, const Unknowns& unknowns);

class WrittenRings {
 public:
  WrittenRings(const Lattice& lattice, const Unknowns& unknowns, Workers& workers);

  // The id of a point, or ~id where it is no unknown.
  using Member = Index;
  static constexpr Index id_of(Member m) { return m < 0 ? ~m : m; }

  struct Ring {
    std::size_t
        member;  // the first of `size`: the point itself, then its neighbours in the order of its chart
    std::uint32_t size;
    Index element;  // control vertex, V + edge, or V + E + face
  };
  const Ring& about(Index p) const { return ring_[std::size_t(p)]; }
  const Member* members(const Ring& ring) const { return member_.data() + ring.member; }
  // The place of a point among the members; their number where it is none.
  std::size_t slot(const Ring& ring, Index p) const {
    const Member* const member = members(ring);
    std::size_t s = 0;
    while (s < ring.size && id_of(member[s]) != p) ++s;
    return s;
  }
  bool is_unknown(Index p) const { return coded_[std::size_t(p)] >= 0; }

 private:
  void code_points(const Unknowns& unknowns);
  void write_vertices();
  void write_edges(Workers& workers);
  void write_faces(Workers& workers);

  const Lattice& lattice_;
  Array<Member> coded_;
  Array<Ring> ring_;  // one a point
  Array<Member> member_;
};

}  // namespace fairing
