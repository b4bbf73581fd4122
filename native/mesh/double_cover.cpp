// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/double_cover.h"

#include <algorithm>

#include "mesh/orientation.h"
#include "parallel/cancel.h"

namespace fairing {
namespace {

class Lifter {
 public:
  Lifter(const PolygonMesh& mesh, const DoubleCover& cover)
      : mesh_(mesh), over_(cover.over), cover_(cover), turned_(over_.size(), 0) {}

  // A centre belongs to one polygon and has its orientation.
  void add_centre(Index copy) {
    over_.push_back(copy);
    turned_.push_back(0);
  }

  // Before the faces of a polygon.
  void add_polygon(Index f) {
    const auto begin = std::size_t(mesh_.offsets[f]),
               end = std::size_t(mesh_.offsets[std::size_t(f) + 1]);
    for (std::size_t k = begin; k < end; ++k) turned_[mesh_.corners[k]] = cover_.turned[k];
  }

  SplitFace half(const SplitFace& face, bool second) const {
    SplitFace out = face;
    const std::size_t size = face.vertex[3] < 0 ? 3 : 4;
    for (std::size_t i = 0; i < size; ++i) {
      const auto v = std::size_t(face.vertex[i]);
      if (bool(turned_[v]) != second) out.vertex[i] = over_[v];
    }
    // The first corner stays first.
    if (second) std::reverse(out.vertex.begin() + 1, out.vertex.begin() + size);
    return out;
  }

 private:
  const PolygonMesh& mesh_;
  std::vector<Index> over_;
  const DoubleCover& cover_;
  std::vector<std::uint8_t> turned_;  // for the vertices of the present polygon
};

}  // namespace

DoubleCover begin_double_cover(const PolygonMesh& mesh, const HalfEdges& half_edges) {
  DoubleCover cover;
  const std::vector<std::int64_t> faces = find_orientation(mesh, half_edges).one_sided;
  if (faces.empty()) return cover;
  cover.one_sided.assign(std::size_t(mesh.face_count()), 0);
  for (const std::int64_t f : faces) cover.one_sided[f] = 1;
  cover.turned.assign(mesh.corners.size(), 0);
  return cover;
}

std::vector<Index> lift_faces(const PolygonMesh& mesh, const DoubleCover& cover, SplitMesh& split,
                              std::vector<Index>& copied_centres) {
  std::vector<Index> repeated;
  if (cover.empty()) return repeated;
  const auto first_centre = Index(mesh.vertex_count()), centres = Index(split.centres.size());
  std::vector<Index> polygon_of(std::size_t(centres), -1);
  for (const SplitFace& face : split.faces)
    for (const Index v : face.vertex)
      if (v >= first_centre) polygon_of[v - first_centre] = face.polygon;
  Lifter lifter(mesh, cover);
  for (Index c = 0; c < centres; ++c) {
    const bool twice = cover.has(polygon_of[c]);
    lifter.add_centre(twice ? first_centre + centres + Index(copied_centres.size()) : -1);
    if (!twice) continue;
    copied_centres.push_back(first_centre + c);
    const Vec3 centre = split.centres[c];
    split.centres.push_back(centre);
  }
  std::vector<SplitFace> second;
  for (const std::size_t f : Cancellable(split.faces.size())) {
    SplitFace& face = split.faces[f];
    if (!cover.has(face.polygon)) continue;
    lifter.add_polygon(face.polygon);
    second.push_back(lifter.half(face, true));
    face = lifter.half(face, false);
    repeated.push_back(Index(f));
  }
  split.faces.insert(split.faces.end(), second.begin(), second.end());
  return repeated;
}

}  // namespace fairing
