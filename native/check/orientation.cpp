// SPDX-License-Identifier: GPL-3.0-or-later
#include "check/orientation.h"

#include <algorithm>

#include "check/listing.h"
#include "execution/cancel.h"

namespace fairing {
namespace {

using Ids = std::vector<std::int64_t>;

bool all_agree(const HalfEdges& half_edges) {
  for (std::int32_t k = 0; k < half_edges.count(); ++k) {
    stop_if_cancelled(std::size_t(k));
    if (half_edges.twin(k) > k && half_edges.runs_as_twin(k)) return false;
  }
  return true;
}

class Parties {
 public:
  Parties(const PolygonMesh& mesh, const HalfEdges& half_edges)
      : mesh_(mesh), half_edges_(half_edges), party_(std::size_t(mesh.face_count()), 0) {}

  bool seen(std::int32_t f) const { return party_[std::size_t(f)] != 0; }

  // Spreads from the face to its whole component; false if the component is one-sided.
  bool visit(std::int32_t seed) {
    component_.assign(1, seed);
    party_[std::size_t(seed)] = 1;
    bool two_sided = true;
    for (std::size_t i = 0; i < component_.size(); ++i) {
      stop_if_cancelled(i);
      const auto f = std::size_t(component_[i]);
      for (auto k = std::int32_t(mesh_.offsets[f]); k < mesh_.offsets[f + 1]; ++k) {
        if (half_edges_.twin(k) < 0) continue;
        const std::int32_t neighbour = half_edges_.face(half_edges_.twin(k));
        const auto wanted = std::int8_t(half_edges_.runs_as_twin(k) ? -party_[f] : party_[f]);
        auto& party = party_[std::size_t(neighbour)];
        if (party == 0) {
          party = wanted;
          component_.push_back(neighbour);
        } else if (party != wanted) {
          two_sided = false;
        }
      }
    }
    return two_sided;
  }

  const std::vector<std::int32_t>& component() const { return component_; }

  void append_smaller_party(Ids& faces) const {
    const auto in_party = [&](std::int8_t side) {
      return [this, side](std::int32_t f) { return party_[std::size_t(f)] == side; };
    };
    const auto second = std::count_if(component_.begin(), component_.end(), in_party(-1));
    const auto smaller = std::int8_t(2 * std::size_t(second) > component_.size() ? 1 : -1);
    std::copy_if(component_.begin(), component_.end(), std::back_inserter(faces), in_party(smaller));
  }

 private:
  const PolygonMesh& mesh_;
  const HalfEdges& half_edges_;
  std::vector<std::int8_t> party_;
  std::vector<std::int32_t> component_;
};

}  // namespace

Orientation find_orientation(const PolygonMesh& mesh, const HalfEdges& half_edges) {
  Orientation result;
  if (all_agree(half_edges)) return result;
  Parties parties(mesh, half_edges);
  Ids &to_flip = result.to_flip, &one_sided = result.one_sided;
  for (std::int32_t f = 0; f < mesh.face_count(); ++f) {
    if (parties.seen(f)) continue;
    if (parties.visit(f))
      parties.append_smaller_party(to_flip);
    else
      one_sided.insert(one_sided.end(), parties.component().begin(), parties.component().end());
  }
  std::sort(one_sided.begin(), one_sided.end());
  std::sort(to_flip.begin(), to_flip.end());
  return result;
}

void check_orientation(const Orientation& orientation, bool repair, Defects& found) {
  const auto& [to_flip, one_sided] = orientation;
  if (!one_sided.empty())
    found.emplace_back(ErrorCode::non_orientable,
                       listing(face_s, one_sided, {"belongs", "belong"}) +
                           " to a surface with only one side, like a Möbius strip: no turning of faces can "
                           "help. Cut it open.",
                       one_sided);
  if (!to_flip.empty())
    found.emplace_back(
        ErrorCode::inconsistent_orientation,
        listing(face_s, to_flip, {"looks", "look"}) +
            " the other way than the neighbours. Recalculate the normals, or ask for the repair.",
        to_flip, repair ? Severity::warning : Severity::error);
}

}  // namespace fairing
