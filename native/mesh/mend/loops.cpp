// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/mend/loops.h"

#include <algorithm>
#include <unordered_map>

#include "parallel/cancel.h"

namespace fairing {
namespace {

// Of so many corners a walk is searched one by one, of more by a table.
constexpr std::size_t short_walk = 16;

// The place of every vertex on the open end of a walk.
class Places {
 public:
  explicit Places(std::size_t size) : by_table_(size > short_walk) {}

  std::ptrdiff_t find(const Loop& open, Index vertex) const {
    if (by_table_) {
      const auto at = table_.find(vertex);
      return at == table_.end() ? -1 : at->second;
    }
    for (std::size_t i = 0; i < open.size(); ++i)
      if (open[i].vertex == vertex) return std::ptrdiff_t(i);
    return -1;
  }
  void add(Index vertex, std::size_t place) {
    if (by_table_) table_[vertex] = std::ptrdiff_t(place);
  }
  void remove(Index vertex) {
    if (by_table_) table_.erase(vertex);
  }

 private:
  bool by_table_;
  std::unordered_map<Index, std::ptrdiff_t> table_;
};

}  // namespace

std::vector<Loop> simple_loops(std::span<const MendCorner> walk) {
  std::vector<Loop> found;
  Loop open;
  Places places(walk.size());
  const auto keep = [&](Loop&& loop) {
    if (loop.size() >= 3) found.push_back(std::move(loop));
  };
  for (const MendCorner& corner : walk) {
    const std::ptrdiff_t before = places.find(open, corner.vertex);
    if (before < 0) {
      places.add(corner.vertex, open.size());
      open.push_back(corner);
      continue;
    }
    Loop loop(open.begin() + before, open.end());
    for (std::size_t i = 1; i < loop.size(); ++i) places.remove(loop[i].vertex);
    open.resize(std::size_t(before) + 1);
    keep(std::move(loop));
  }
  keep(std::move(open));
  return found;
}

OwnedPolygonMesh to_arrays(const Loops& loops, std::vector<double> coordinates) {
  OwnedPolygonMesh mesh;
  mesh.coordinates = std::move(coordinates);
  mesh.corners.reserve(loops.corners.size());
  for (std::size_t k = 0; k < loops.corners.size(); ++k) {
    stop_if_cancelled(k);
    mesh.corners.push_back(loops.corners[k].vertex);
  }
  mesh.offsets.assign(loops.offsets.begin(), loops.offsets.end());
  return mesh;
}

}  // namespace fairing
