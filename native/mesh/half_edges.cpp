// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/half_edges.h"

#include <algorithm>

#include "parallel/cancel.h"

namespace fairing {
namespace {

struct Entry {
  std::int32_t high, half_edge;  // an edge is filed under its lower vertex
  bool operator<(const Entry& other) const { return high < other.high; }
};

}  // namespace

HalfEdges::HalfEdges(const PolygonMesh& mesh)
    : mesh_(mesh), face_(mesh.corners.size()), twin_(mesh.corners.size(), -1) {
  for (std::int64_t f = 0; f < mesh.face_count(); ++f) {
    stop_if_cancelled(std::size_t(f));
    std::fill(face_.begin() + mesh.offsets[std::size_t(f)],
              face_.begin() + mesh.offsets[std::size_t(f) + 1], std::int32_t(f));
  }
  find_twins();
}

std::int32_t HalfEdges::next(std::int32_t k) const {
  const auto f = std::size_t(face(k));
  return k + 1 == mesh_.offsets[f + 1] ? std::int32_t(mesh_.offsets[f]) : k + 1;
}

std::int32_t HalfEdges::previous(std::int32_t k) const {
  const auto f = std::size_t(face(k));
  return k == mesh_.offsets[f] ? std::int32_t(mesh_.offsets[f + 1]) - 1 : k - 1;
}

// A counting sort by lower vertex leaves buckets of about three: linear time, and no hashing.
void HalfEdges::find_twins() {
  std::vector<std::int32_t> start(std::size_t(mesh_.vertex_count()) + 1, 0);
  const auto low = [&](std::int32_t k) { return std::size_t(std::min(from(k), from(next(k)))); };
  for (std::int32_t k = 0; k < count(); ++k) {
    stop_if_cancelled(std::size_t(k));
    ++start[low(k) + 1];
  }
  for (std::size_t v = 1; v < start.size(); ++v) start[v] += start[v - 1];

  std::vector<Entry> entries(face_.size());
  std::vector<std::int32_t> fill(start.begin(), start.end() - 1);
  for (std::int32_t k = 0; k < count(); ++k) {
    stop_if_cancelled(std::size_t(k));
    entries[std::size_t(fill[low(k)]++)] = {std::int32_t(std::max(from(k), from(next(k)))), k};
  }

  for (std::size_t v = 0; v + 1 < start.size(); ++v) {
    stop_if_cancelled(v);
    const auto begin = entries.begin() + start[v], end = entries.begin() + start[v + 1];
    std::sort(begin, end);
    for (auto first = begin; first != end;) {
      const auto last =
          std::find_if(first, end, [&](const Entry& e) { return e.high != first->high; });
      if (last - first == 2) {
        twin_[std::size_t(first[0].half_edge)] = first[1].half_edge;
        twin_[std::size_t(first[1].half_edge)] = first[0].half_edge;
      } else if (last - first > 2) {
        nonmanifold_edges_.insert(nonmanifold_edges_.end(), {std::int64_t(v), first->high});
        nonmanifold_sides_ += last - first;
      }
      first = last;
    }
  }
}

}  // namespace fairing
