// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/orientation.h"

#include <algorithm>
#include <iterator>

#include "parallel/cancel.h"

namespace fairing {
namespace {

using Ids = std::vector<std::int64_t>;

bool all_agree(const HalfEdges& half_edges) {
  for (const std::int32_t k : Cancellable(half_edges.count())) {
    if (half_edges.twin(k) > k && half_edges.runs_as_twin(k)) return false;
  }
  return true;
}

// Finds the orientation of each face relative to the first one of its component: +1 or -1.
class Senses {
 public:
  Senses(const PolygonMesh& mesh, const HalfEdges& half_edges)
      : mesh_(mesh), half_edges_(half_edges), sense_(std::size_t(mesh.face_count()), 0) {}

  bool seen(std::int32_t f) const { return sense_[f] != 0; }

  // Visits the component of a face. Returns whether it is two-sided.
  bool visit(std::int32_t seed) {
    component_.assign(1, seed);
    sense_[seed] = 1;
    bool two_sided = true;
    for (std::size_t i = 0; i < component_.size(); ++i) {
      stop_if_cancelled(i);
      const auto f = std::size_t(component_[i]);
      for (auto k = std::int32_t(mesh_.offsets[f]); k < mesh_.offsets[f + 1]; ++k) {
        if (half_edges_.twin(k) < 0) continue;
        const std::int32_t neighbour = half_edges_.face(half_edges_.twin(k));
        const auto wanted = std::int8_t(half_edges_.runs_as_twin(k) ? -sense_[f] : sense_[f]);
        auto& sense = sense_[neighbour];
        if (sense == 0) {
          sense = wanted;
          component_.push_back(neighbour);
        } else if (sense != wanted) {
          two_sided = false;
        }
      }
    }
    return two_sided;
  }

  const std::vector<std::int32_t>& component() const { return component_; }

  void append_minority(Ids& faces) const {
    const auto has = [&](std::int8_t side) {
      return [this, side](std::int32_t f) { return sense_[f] == side; };
    };
    const auto second = std::count_if(component_.begin(), component_.end(), has(-1));
    const auto smaller = std::int8_t(2 * std::size_t(second) > component_.size() ? 1 : -1);
    std::copy_if(component_.begin(), component_.end(), std::back_inserter(faces), has(smaller));
  }

 private:
  const PolygonMesh& mesh_;
  const HalfEdges& half_edges_;
  std::vector<std::int8_t> sense_;
  std::vector<std::int32_t> component_;
};

}  // namespace

Orientation find_orientation(const PolygonMesh& mesh, const HalfEdges& half_edges) {
  Orientation result;
  if (all_agree(half_edges)) return result;
  Senses senses(mesh, half_edges);
  Ids &to_flip = result.to_flip, &one_sided = result.one_sided;
  for (std::int32_t f = 0; f < mesh.face_count(); ++f) {
    if (senses.seen(f)) continue;
    if (senses.visit(f))
      senses.append_minority(to_flip);
    else
      one_sided.insert(one_sided.end(), senses.component().begin(), senses.component().end());
  }
  std::sort(one_sided.begin(), one_sided.end());
  std::sort(to_flip.begin(), to_flip.end());
  return result;
}

OwnedPolygonMesh with_flipped(const PolygonMesh& mesh, std::span<const std::int64_t> faces) {
  OwnedPolygonMesh out{{mesh.coordinates.begin(), mesh.coordinates.end()},
                       {mesh.corners.begin(), mesh.corners.end()},
                       {mesh.offsets.begin(), mesh.offsets.end()}};
  for (std::int64_t f : faces)
    std::reverse(out.corners.begin() + out.offsets[f] + 1,
                 out.corners.begin() + out.offsets[std::size_t(f) + 1]);
  return out;
}

}  // namespace fairing
