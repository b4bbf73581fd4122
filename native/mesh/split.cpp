// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/split.h"

#include <algorithm>
#include <optional>
#include <unordered_map>

#include "base/error.h"
#include "base/points.h"
#include "mesh/polygon_shape.h"
#include "parallel/cancel.h"

namespace fairing {
namespace {

// The triangulation takes cubic time.
constexpr std::size_t most_corners_to_cut = 1000;

enum class Treatment : std::uint8_t { keep, fan, cut };

PolygonShape shape_of(const PolygonMesh& mesh, std::span<const std::int64_t> face) {
  std::vector<Vec3> corners;
  for (std::int64_t v : face) corners.push_back(point_at(mesh.coordinates, v));
  return PolygonShape(corners);
}

// Vertices surrounded by two faces: only a cut through one of these gives them a third spoke.
std::vector<std::uint8_t> pinched_vertices(const PolygonMesh& mesh) {
  struct Corner {
    std::int64_t before = -1, after = -1;
  };
  std::vector<Corner> first(std::size_t(mesh.vertex_count()));
  std::vector<std::uint8_t> faces(first.size(), 0), pinched(first.size(), 0);
  for (const std::int64_t f : Cancellable(mesh.face_count())) {
    const auto face = mesh.face(f);
    for (std::size_t i = 0; i < face.size(); ++i) {
      const auto v = std::size_t(face[i]);
      const Corner corner{face[(i + face.size() - 1) % face.size()], face[(i + 1) % face.size()]};
      if (faces[v] == 0) first[v] = corner;
      // Neighbours in a one-sided sheet may have either orientation.
      const bool against = corner.before == first[v].after && corner.after == first[v].before,
                 along = corner.before == first[v].before && corner.after == first[v].after;
      pinched[v] = faces[v] == 1 && (against || along);
      faces[v] = std::uint8_t(std::min(3, faces[v] + 1));
    }
  }
  return pinched;
}

// The vertex pairs that a cut may join. A pair is excluded if an edge has it, or if two faces want
// it: neither face gets it then, since any choice would depend on the order of faces.
class Diagonals {
 public:
  void propose(std::int64_t a, std::int64_t b) { ++wanted_[key(a, b)]; }
  void mark_used(std::int64_t a, std::int64_t b) {
    if (const auto found = wanted_.find(key(a, b)); found != wanted_.end()) found->second = 2;
  }
  bool allowed(std::int64_t a, std::int64_t b) const { return wanted_.at(key(a, b)) == 1; }
  bool empty() const { return wanted_.empty(); }

 private:
  static std::uint64_t key(std::int64_t a, std::int64_t b) {
    return std::uint64_t(std::min(a, b)) << 32 | std::uint64_t(std::max(a, b));
  }
  std::unordered_map<std::uint64_t, int> wanted_;
};

class Splitter {
 public:
  Splitter(const PolygonMesh& mesh, std::span<const Index> copied)
      : mesh_(mesh),
        copied_(copied),
        first_copy_(mesh.vertex_count() - std::int64_t(copied.size())) {}

  SplitMesh split() {
    choose_treatments();
    find_free_diagonals();
    for (const std::int64_t f : Cancellable(mesh_.face_count())) {
      const auto face = mesh_.face(f);
      switch (treatment_[f]) {
        case Treatment::keep: add_face(f, face); break;
        case Treatment::fan: add_fan(f, face); break;
        case Treatment::cut: add_cut(f); break;
      }
    }
    return std::move(result_);
  }

 private:
  void choose_treatments() {
    const std::vector<std::uint8_t> pinched = pinched_vertices(mesh_);
    std::vector<std::int64_t> too_long;
    for (const std::int64_t f : Cancellable(mesh_.face_count())) {
      treatment_.push_back(choose(f, pinched));
      if (treatment_.back() == Treatment::cut && mesh_.face(f).size() > most_corners_to_cut)
        too_long.push_back(f);
    }
    if (!too_long.empty())
      throw FairingError(
          ErrorCode::too_large,
          {"{face} {has|have} more than 1000 corners and no point that sees them all.",
           "Cut them into smaller ones."},
          too_long);
  }

  Treatment choose(std::int64_t f, const std::vector<std::uint8_t>& pinched) const {
    const auto face = mesh_.face(f);
    if (face.size() == 3) return Treatment::keep;
    const PolygonShape shape = shape_of(mesh_, face);
    if (face.size() > 4) return shape.star_shaped() ? Treatment::fan : Treatment::cut;
    const bool has_pinched =
        std::any_of(face.begin(), face.end(), [&](std::int64_t v) { return pinched[v]; });
    return has_pinched || shape.concave() || shape.warped() ? Treatment::cut : Treatment::keep;
  }

  void find_free_diagonals() {
    for (std::int64_t f = 0; f < mesh_.face_count(); ++f) {
      if (treatment_[f] != Treatment::cut) continue;
      stop_if_cancelled();
      const auto face = mesh_.face(f);
      for (std::size_t i = 0; i + 2 < face.size(); ++i)
        for (std::size_t j = i + 2; j < face.size() && j - i < face.size() - 1; ++j)
          diagonals_.propose(original(face[i]), original(face[j]));
    }
    if (diagonals_.empty()) return;
    for (const std::int64_t f : Cancellable(mesh_.face_count())) {
      const auto face = mesh_.face(f);
      for (std::size_t i = 0; i < face.size(); ++i)
        diagonals_.mark_used(original(face[i]), original(face[(i + 1) % face.size()]));
    }
  }

  void add_face(std::int64_t f, std::span<const std::int64_t> face) {
    SplitFace added{{-1, -1, -1, -1}, Index(f)};
    for (std::size_t i = 0; i < face.size(); ++i) added.vertex[i] = Index(face[i]);
    result_.faces.push_back(added);
  }

  void add_fan(std::int64_t f, std::span<const std::int64_t> corners) {
    const auto c = Index(mesh_.vertex_count() + std::int64_t(result_.centres.size()));
    result_.centres.push_back(shape_of(mesh_, corners).centroid());
    for (std::size_t i = 0; i < corners.size(); ++i)
      result_.faces.push_back(
          {{Index(corners[i]), Index(corners[(i + 1) % corners.size()]), c, -1}, Index(f)});
  }

  void add_cut(std::int64_t f) {
    const auto face = mesh_.face(f);
    const auto allowed = [&](std::size_t i, std::size_t j) {
      return diagonals_.allowed(original(face[i]), original(face[j]));
    };
    for (const Piece& piece : cut_polygon(shape_of(mesh_, face), allowed)) {
      std::vector<std::int64_t> corners;
      for (std::size_t i : piece) corners.push_back(face[i]);
      if (piece.size() == 3)
        add_face(f, corners);
      else
        add_fan(f, corners);
    }
  }

  std::int64_t original(std::int64_t v) const {
    return v < first_copy_ ? v : copied_[v - first_copy_];
  }

  const PolygonMesh& mesh_;
  std::span<const Index> copied_;
  std::int64_t first_copy_;
  std::vector<Treatment> treatment_;
  Diagonals diagonals_;
  SplitMesh result_;
};

}  // namespace

SplitMesh split_polygons(const PolygonMesh& mesh, std::span<const Index> copied) {
  return Splitter(mesh, copied).split();
}

}  // namespace fairing
