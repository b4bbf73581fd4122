// SPDX-License-Identifier: GPL-3.0-or-later
#include "reference_rings.h"

namespace fairing::test {
namespace {

std::uint64_t key(Index from, Index to) {
  return std::uint64_t(std::uint32_t(from)) << 32 | std::uint32_t(to);
}

std::size_t size(const Cell& cell) { return cell[3] < 0 ? 3 : 4; }

}  // namespace

std::vector<Cell> cells(const GridLevel& grid) {
  std::vector<Cell> all;
  const int n = grid.n();
  for (Index f = 0; f < Index(grid.mesh().faces.size()); ++f) {
    const auto at = [&](int i, int j) { return grid.face_point(f, i, j); };
    if (grid.mesh().faces[std::size_t(f)].quad()) {
      for (int j = 0; j < n; ++j)
        for (int i = 0; i < n; ++i)
          all.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)});
    } else {
      for (int j = 0; j < n; ++j)
        for (int i = 0; i < n - j; ++i) {
          all.push_back({at(i, j), at(i + 1, j), at(i, j + 1), -1});
          if (i + j < n - 1) all.push_back({at(i + 1, j), at(i + 1, j + 1), at(i, j + 1), -1});
        }
    }
  }
  return all;
}

RingWalker::RingWalker(std::vector<Cell> all) : cells_(std::move(all)) {
  for (std::size_t c = 0; c < cells_.size(); ++c)
    for (std::size_t k = 0; k < size(cells_[c]); ++k)
      steps_.emplace(key(cells_[c][k], cells_[c][(k + 1) % size(cells_[c])]), Step{int(c), int(k)});
}

const RingWalker::Step* RingWalker::find(Index from, Index to) const {
  const auto step = steps_.find(key(from, to));
  return step == steps_.end() ? nullptr : &step->second;
}

std::vector<RingNeighbour> RingWalker::ring(Index centre, Index first) const {
  std::vector<RingNeighbour> out{{first}};
  const auto walk = [&](Index from) {
    for (Index at = from;;) {
      const Step* step = find(centre, at);
      if (!step) return;
      const Cell& cell = cells_[std::size_t(step->cell)];
      const std::size_t n = size(cell), k = std::size_t(step->corner);
      if (n == 4) out.push_back({cell[(k + 2) % 4], step->cell});
      at = cell[(k + n - 1) % n];
      if (at == first) return;
      out.push_back({at});
    }
  };
  walk(first);
  if (find(first, centre)) {  // something lies clockwise of `first` …
    Index start = first;
    for (const Step* step = find(start, centre); step; step = find(start, centre)) {
      const Cell& cell = cells_[std::size_t(step->cell)];
      start = cell[(std::size_t(step->corner) + 2) % size(cell)];
      if (start == first) return out;  // … the other end of a closed ring
    }
    out.push_back({start});
    walk(start);
  }
  return out;
}

}  // namespace fairing::test
