// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/mend/loops.h"

#include <algorithm>
#include <unordered_map>

#include "parallel/cancel.h"

namespace fairing {
namespace {

// Whether more than one vertex is repeated, apart from doubled corners: then the result of cutting
// the walk depends on its first corner.
bool is_ambiguous(std::span<const MendCorner> walk) {
  std::vector<Index> vertices;
  for (std::size_t i = 0; i < walk.size(); ++i)
    if (walk[i].vertex != walk[(i + 1) % walk.size()].vertex) vertices.push_back(walk[i].vertex);
  std::sort(vertices.begin(), vertices.end());
  int again = 0;
  for (std::size_t i = 0; i + 1 < vertices.size(); ++i)
    again += vertices[i] == vertices[i + 1] && (i == 0 || vertices[i - 1] != vertices[i]);
  return again > 1;
}

// The first corner of the walk's least rotation: the place of a cut must not depend on the corner
// that a file names first.
std::size_t least_rotation(std::span<const MendCorner> walk) {
  std::vector<Index> twice = vertices_of(walk);
  twice.insert(twice.end(), twice.begin(), twice.end());
  const auto rotation = [&](std::size_t first) {
    return std::span(twice).subspan(first, walk.size());
  };
  std::size_t least = 0;
  for (std::size_t i = 1; i < walk.size(); ++i)
    if (std::ranges::lexicographical_compare(rotation(i), rotation(least))) least = i;
  return least;
}

}  // namespace

std::vector<Loop> simple_loops(std::span<const MendCorner> walk) {
  std::vector<Loop> found;
  Loop open;
  const auto keep = [&](Loop&& loop) {
    if (loop.size() >= 3) found.push_back(std::move(loop));
  };
  const std::size_t first = is_ambiguous(walk) ? least_rotation(walk) : 0;
  std::unordered_map<Index, std::size_t> places;  // of the vertices on the open end
  for (std::size_t i = 0; i < walk.size(); ++i) {
    const MendCorner& corner = walk[(first + i) % walk.size()];
    const auto [at, is_new] = places.try_emplace(corner.vertex, open.size());
    if (is_new) {
      open.push_back(corner);
      continue;
    }
    Loop loop(open.begin() + at->second, open.end());
    for (std::size_t k = 1; k < loop.size(); ++k) places.erase(loop[k].vertex);
    open.resize(at->second + 1);
    keep(std::move(loop));
  }
  keep(std::move(open));
  return found;
}

OwnedPolygonMesh to_arrays(const Loops& loops, std::vector<double> coordinates) {
  OwnedPolygonMesh mesh;
  mesh.coordinates = std::move(coordinates);
  mesh.corners.reserve(loops.corners.size());
  for (const std::size_t k : Cancellable(loops.corners.size())) {
    mesh.corners.push_back(loops.corners[k].vertex);
  }
  mesh.offsets.assign(loops.offsets.begin(), loops.offsets.end());
  return mesh;
}

}  // namespace fairing
