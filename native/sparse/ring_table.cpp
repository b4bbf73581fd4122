// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse/ring_table.h"

#include "grid/runs.h"

namespace fairing {

RingTable::RingTable(const GridLevel& grid, const Unknowns& unknowns, Workers& workers)
    : grid_(grid) {
  code_points(unknowns);
  lay_out_rings();
  write_members(workers);
}

void RingTable::code_points(const Unknowns& unknowns) {
  const std::vector<std::uint8_t> unknown = unknown_points(grid_, unknowns);
  coded_.resize(unknown.size());
  for (std::size_t p = 0; p < unknown.size(); ++p) coded_[p] = unknown[p] ? Index(p) : ~Index(p);
}

void RingTable::lay_out_rings() {
  const ControlMesh& mesh = grid_.mesh();
  std::size_t members = 0;
  for_each_run(grid_, [&](const Run& run) {
    const auto size = std::uint32_t(neighbours(mesh, run) + 1);
    const Index element = element_of(mesh, run);
    for (std::size_t i = 0; i < run.count; ++i, members += size)
      ring_.push_back({members, size, element});
  });
  member_.resize(members);
}

void RingTable::write_members(Workers& workers) {
  for_each_run(
      grid_, workers, [&] { return RunGather<Member>(grid_, coded_.data()); },
      [&](const Run& run, RunGather<Member>& gather) {
        const Member* const* at = gather(run);
        const std::size_t size = ring_[run.first].size;
        Member* to = member_.data() + ring_[run.first].member;
        for (std::size_t i = 0; i < run.count; ++i)
          for (std::size_t s = 0; s < size; ++s) *to++ = at[s][i];
      });
}

}  // namespace fairing
