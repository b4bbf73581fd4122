// SPDX-License-Identifier: GPL-3.0-or-later
// The faces with a side between two vertices, while faces change. For mesh/mend/ only.
// (mesh/half_edges.h is for faces that do not change, and knows only one other face.)
#pragma once

#include <algorithm>
#include <unordered_map>
#include <vector>

#include "mesh/mend/loops.h"

namespace fairing {

class EdgeFaces {
 public:
  using Key = std::uint64_t;

  static Key key(Index a, Index b) {
    return Key(std::uint32_t(std::min(a, b))) << 32 | std::uint32_t(std::max(a, b));
  }

  explicit EdgeFaces(const Loops& loops) {
    sides_.reserve(loops.corners.size());
    for (Index f = 0; f < loops.count(); ++f)
      for_sides(loops.face(f), [&](Key side) { sides_.push_back({side, f}); });
    std::sort(sides_.begin(), sides_.end());
  }

  // Adds a new face, or a new side of a face.
  void add(std::span<const MendCorner> loop, Index f) {
    for_sides(loop, [&](Key side) { added_[side].push_back(f); });
  }
  void add(Index a, Index b, Index f) { added_[key(a, b)].push_back(f); }

  // All faces that ever had this side, ascending; the caller checks whether they still have it.
  std::vector<Index> around(Index a, Index b) const {
    std::vector<Index> faces;
    const Key side = key(a, b);
    for (auto at = std::lower_bound(sides_.begin(), sides_.end(), std::pair<Key, Index>(side, -1));
         at != sides_.end() && at->first == side; ++at)
      faces.push_back(at->second);
    if (const auto later = added_.find(side); later != added_.end())
      faces.insert(faces.end(), later->second.begin(), later->second.end());
    std::sort(faces.begin(), faces.end());
    faces.erase(std::unique(faces.begin(), faces.end()), faces.end());
    return faces;
  }

 private:
  template <class Visit>
  static void for_sides(std::span<const MendCorner> loop, Visit&& visit) {
    for (std::size_t i = 0; i < loop.size(); ++i)
      visit(key(loop[i].vertex, loop[(i + 1) % loop.size()].vertex));
  }

  Array<std::pair<Key, Index>> sides_;
  std::unordered_map<Key, std::vector<Index>> added_;
};

}  // namespace fairing
