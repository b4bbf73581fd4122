// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/flat_faces.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>

#include "mesh/flat_outlines.h"
#include "mesh/opposite.h"
#include "mesh/region.h"
#include "mesh/sharp_turn.h"
#include "mesh/union_find.h"

namespace fairing {

namespace {

// Plane parts of the chosen faces, and the folds between them.
class FlatParts {
 public:
  FlatParts(const ControlMesh& mesh, std::span<const std::uint8_t> chosen)
      : mesh_(mesh), lead_(mesh.faces.size()), part_(mesh.faces.size()) {
    for (const Face& face : mesh_.faces) planes_.push_back(plane_of(face, mesh_.positions));
    find(chosen);
    for_each_fold([](Part& part, const Part&, const Vec3& fold) {
      if (fold.norm() > part.longest.norm()) part.longest = fold;
    });
    measure();
    for_each_fold([](Part& part, const Part& other, const Vec3& fold) { part.add(fold, other); });
  }

  // The first face of a face's part.
  Index first(Index face) { return lead_.lead(face); }
  // The direction in which the face stays straight; zero: it stays plane.
  Vec3 along(Index face) {
    const Part& part = part_[lead_.lead(face)];
    const bool straight = !part.crossed && part.width() <= 2 * part.beside;
    return straight ? Vec3(part.mean.normalized()) : Vec3(Vec3::Zero());
  }

 private:
  struct Part {
    Vec3 longest = Vec3::Zero(), mean = Vec3::Zero();  // of the folds
    Vec3 across = Vec3::Zero();                        // unit length, in the part's plane
    double low = 0, high = 0;                          // the part's extent across the longest fold
    double beside = 0;                                 // width of the widest part at a fold
    bool crossed = false;

    double width() const { return high - low; }
    void add(const Vec3& fold, const Part& other) {
      const double with = fold.dot(longest);
      mean += with < 0 ? Vec3(-fold) : fold;
      crossed = crossed || std::abs(with) < sharp_turn * fold.norm() * longest.norm();
      beside = std::max(beside, other.width());
    }
  };

  Index face_at(Index e, int k) const { return mesh_.sides[mesh_.edges[e].side[k]].face; }

  void find(std::span<const std::uint8_t> chosen) {
    const auto is_chosen = [&](Index f) { return chosen[std::size_t(mesh_.faces[f].polygon)]; };
    for (Index e = 0; e < Index(mesh_.edges.size()); ++e) {
      if (mesh_.edges[e].boundary() || mesh_.feature_edge[e]) continue;
      const Index a = face_at(e, 0), b = face_at(e, 1);
      if (!is_chosen(a) || !is_chosen(b)) continue;
      if (in_one_plane(planes_[a], planes_[b]))
        lead_.unite(a, b);
      else if (planes_[a].normal.dot(planes_[b].normal) > sharp_turn)
        folds_.push_back(e);
    }
  }

  // visit(part, the part across, the fold), from both sides of every fold.
  template <class Visit>
  void for_each_fold(Visit&& visit) {
    for (const Index e : folds_) {
      const auto [v, w] = mesh_.edges[e].vertex;
      const Vec3 fold = mesh_.positions[w] - mesh_.positions[v];
      Part &a = part_[lead_.lead(face_at(e, 0))], &b = part_[lead_.lead(face_at(e, 1))];
      visit(a, b, fold);
      visit(b, a, fold);
    }
  }

  void measure() {
    for (Index f = 0; f < Index(mesh_.faces.size()); ++f) {
      const Index lead = lead_.lead(f);
      Part& part = part_[lead];
      const bool first = lead == f;  // it is the least of the part
      if (first) part.across = planes_[f].normal.cross(part.longest).normalized();
      for (int c = 0; c < mesh_.faces[f].size; ++c) {
        const double place = part.across.dot(mesh_.positions[mesh_.faces[f].vertex[c]]);
        part.low = first && c == 0 ? place : std::min(part.low, place);
        part.high = first && c == 0 ? place : std::max(part.high, place);
      }
    }
  }

  const ControlMesh& mesh_;
  std::vector<FacePlane> planes_;
  UnionFind lead_;
  std::vector<Part> part_;  // by their first faces
  std::vector<Index> folds_;
};

}  // namespace

void mark_flat_faces(std::span<const std::int64_t> faces, ControlMesh& control) {
  if (faces.empty()) return;
  const auto chosen = flags_of_faces(faces, control.input_faces, "flat_faces");
  FlatFaces& flat = control.flat;
  FlatParts parts(control, chosen);
  for (Index f = 0; f < Index(control.faces.size()); ++f) {
    const bool kept = chosen[std::size_t(control.faces[f].polygon)];
    flat.along.push_back(kept ? parts.along(f) : Vec3(Vec3::Zero()));
    flat.face.push_back(kept && !flat.is_straight(f));
    flat.part.push_back(parts.first(f));
  }
  for (const Edge& edge : control.edges)
    flat.edge.push_back(std::all_of(edge.side.begin(), edge.side.end(), [&](Index s) {
      return s < 0 || flat.face[std::size_t(control.sides[std::size_t(s)].face)];
    }));
  for (Index v = 0; v < control.vertex_count(); ++v) {
    const auto ring = control.ring(v);
    flat.vertex.push_back(!ring.empty() &&
                          std::all_of(ring.begin(), ring.end(), [&](const Spoke& spoke) {
                            return spoke.face < 0 || flat.face[std::size_t(spoke.face)];
                          }));
  }
}

void hold_flat_parts(ControlMesh& control) {
  const FlatFaces& flat = control.flat;
  // where a region may fold at its joint, it would fold around flats too
  if (flat.face.empty() || control.region.joint == RegionContinuity::position) return;
  std::vector<std::uint8_t> beside_curve(control.faces.size(), 0), held;
  for (const Side& side : control.sides)
    if (control.feature_edge[side.edge]) beside_curve[flat.part[side.face]] = 1;
  for (std::size_t f = 0; f < control.faces.size(); ++f)
    held.push_back(flat.face[f] && !beside_curve[flat.part[f]]);
  if (std::ranges::find(held, 1) != held.end()) {
    put_outside(held, control);
    add_flat_outlines(held, control);
  }
}

std::vector<Flatness> flatness(const ControlMesh& control) {
  std::vector<FacePlane> planes;
  for (const Face& face : control.faces) planes.push_back(plane_of(face, control.positions));
  const auto vertices = std::size_t(control.vertex_count());
  std::vector<std::uint8_t> flat(vertices), inside(vertices), paired(vertices);
  for (std::size_t v = 0; v < vertices; ++v) {
    const auto ring = control.ring(Index(v));
    flat[v] = std::all_of(ring.begin(), ring.end(), [&](const Spoke& spoke) {
      return spoke.face < 0 || in_one_plane(planes[ring[0].face], planes[spoke.face]);
    });
    inside[v] = flat[v] && Index(v) < control.first_centre() &&
                std::none_of(ring.begin(), ring.end(), [](const Spoke& s) { return s.face < 0; });
  }
  for (const Edge& edge : control.edges) {
    const auto [a, b] = edge.vertex;
    if (inside[a] && inside[b]) paired[a] = paired[b] = 1;
  }
  std::vector<Flatness> out;
  for (const Face& face : control.faces) {
    const auto corners = std::span(face.vertex).first(std::size_t(face.size));
    const bool amid = std::all_of(corners.begin(), corners.end(), [&](Index v) { return flat[v]; });
    const bool beside =
        std::any_of(corners.begin(), corners.end(), [&](Index v) { return paired[v]; });
    out.push_back(amid ? Flatness::amid : beside ? Flatness::beside : Flatness::none);
  }
  return out;
}

}  // namespace fairing
