// SPDX-License-Identifier: GPL-3.0-or-later
// The one-rings of a level's points as lists of points, from which rows of sparse matrices are
// summed. 4 bytes a neighbour and 16 a point.
#pragma once

#include "parallel/memory.h"
#include "parallel/workers.h"
#include "sparse/unknown_points.h"
#include "stencil/stencils.h"

namespace fairing {

class RingTable {
 public:
  // `grid` must outlive the table. Throws where the run has been cancelled.
  RingTable(const GridLevel& grid, const Unknowns& unknowns, Workers& workers);

  // The id of a point, or ~id if it is not an unknown.
  using Member = Index;
  static constexpr Index id_of(Member m) { return m < 0 ? ~m : m; }

  struct Ring {
    // The first of `size` members: the point itself, then its neighbours in the order of its chart
    // (stencil/chart.h).
    std::size_t member;
    std::uint32_t size;
    Index element;  // whose stencil the point has (stencil/stencils.h)
  };
  const Ring& about(Index p) const { return ring_[p]; }
  const Member* members(const Ring& ring) const { return member_.data() + ring.member; }
  // The position of a point in the ring; `size` if it is not a member.
  std::size_t slot(const Ring& ring, Index p) const {
    const Member* const member = members(ring);
    std::size_t s = 0;
    while (s < ring.size && id_of(member[s]) != p) ++s;
    return s;
  }
  std::size_t points() const { return ring_.size(); }
  bool is_unknown(Index p) const { return coded_[p] >= 0; }

 private:
  void code_points(const Unknowns& unknowns);
  void lay_out_rings();
  void write_members(Workers& workers);

  const GridLevel& grid_;
  Array<Member> coded_;  // one a point
  Array<Ring> ring_;     // one a point
  Array<Member> member_;
};

}  // namespace fairing
