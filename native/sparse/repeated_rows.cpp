// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse/repeated_rows.h"

#include <algorithm>

namespace fairing {

bool RepeatedRows::write(Index p, RowBuilder& row) {
  const auto again = std::find_if(latest_.begin(), latest_.end(),
                                  [&](std::uint8_t k) { return is_again(known_[k], p); });
  if (again == latest_.end() || !row.repeat(known_[*again].numbers, column_)) return false;
  std::rotate(latest_.begin(), again, again + 1);
  return true;
}

// Leaves the row's columns in column_.
bool RepeatedRows::is_again(const Known& known, Index p) {
  const RingTable::Ring& own = rings_.about(p);
  if (known.element.size() != own.size || known.element[0] != own.element) return false;
  const RingTable::Member* const centres = rings_.members(own);
  for (std::size_t k = 1; k < own.size; ++k)
    if (rings_.about(RingTable::id_of(centres[k])).element != known.element[k]) return false;
  column_.assign(known.columns, -1);
  const std::uint8_t* place = known.place.data();
  for (std::size_t k = 0; k < own.size; ++k) {
    const RingTable::Ring& ring = rings_.about(RingTable::id_of(centres[k]));
    const RingTable::Member* const members = rings_.members(ring);
    if (members[known.slot[k]] != p) return false;
    for (std::size_t m = 0; m < ring.size; ++m, ++place) {
      if (*place == fixed ? members[m] >= 0 : members[m] < 0) return false;
      if (*place >= in_no_row) continue;
      Index& column = column_[*place];
      if (column >= 0 && column != members[m]) return false;
      column = members[m];
    }
  }
  return true;
}

// A vertex has one ring, and its row and those next to it are not repeated.
void RepeatedRows::keep(Index p, const RowBuilder& row) {
  const RingTable::Ring& own = rings_.about(p);
  const RingTable::Member* const centres = rings_.members(own);
  for (std::size_t k = 0; k < own.size; ++k) {
    const RingTable::Ring& ring = rings_.about(RingTable::id_of(centres[k]));
    if (rings_.is_about_vertex(ring) || rings_.slot(ring, p) == ring.size) return;
  }
  std::rotate(latest_.begin(), latest_.end() - 1, latest_.end());
  Known& known = known_[latest_[0]];
  known.element.clear();
  known.slot.clear();
  known.place.clear();
  for (std::size_t k = 0; k < own.size; ++k) {
    const RingTable::Ring& ring = rings_.about(RingTable::id_of(centres[k]));
    known.element.push_back(ring.element);
    known.slot.push_back(std::uint8_t(rings_.slot(ring, p)));
    for (std::size_t m = 0; m < ring.size; ++m) {
      const RingTable::Member member = rings_.members(ring)[m];
      std::uint8_t place = member < 0 ? fixed : in_no_row;
      if (member >= 0 && row.names(member)) place = std::uint8_t(row.place(member));
      known.place.push_back(place);
    }
  }
  known.columns = row.columns();
  row.copy_numbers(known.numbers);
}

}  // namespace fairing
