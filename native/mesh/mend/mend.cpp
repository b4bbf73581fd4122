// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/mend/mend.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "mesh/mend/dissolve.h"
#include "mesh/mend/loops.h"
#include "mesh/mend/merge.h"
#include "mesh/validate/checks.h"
#include "parallel/cancel.h"

namespace fairing {
namespace {

using Ids = std::vector<std::int64_t>;

std::size_t bytes_of(const OwnedPolygonMesh& mesh) {
  return mesh.coordinates.capacity() * sizeof(double) +
         (mesh.corners.capacity() + mesh.offsets.capacity()) * sizeof(std::int64_t);
}

}  // namespace

void require_mendable(const PolygonMesh& mesh) {
  Defects found;
  check_arrays(mesh, found);
  for (const Defect& defect : found)
    if (!defect.repairable && defect.code != ErrorCode::non_finite) defect.raise();
  const std::vector<std::uint8_t> used = used_vertices(mesh);
  Ids bad = non_finite_vertices(mesh.coordinates);
  std::erase_if(bad, [&](std::int64_t v) { return !used[v]; });
  if (!bad.empty())
    throw FairingError(ErrorCode::non_finite,
                       {"{vertex} {has|have} a coordinate that is NaN, infinite or beyond 1e100, "
                        "and faces: the surface there is unknown.",
                        "Delete or move them."},
                       bad);
}

namespace {

class Mender {
 public:
  Mender(const PolygonMesh& mesh, const MendOptions& options)
      : mesh_(mesh), options_(options), merges_(std::size_t(mesh.vertex_count())) {}

  MendedMesh run() {
    const bool merged_near = options_.weld >= 0 && merge_near(mesh_, options_.weld, merges_),
               merged = merge_within_faces(mesh_, merges_);
    if (!merged_near && !merged && nothing_wrong()) return {};
    set_faces();
    drop_duplicates();
    Dissolved dissolved = dissolve_flat_faces(mesh_.coordinates, loops_);
    if (!dissolved.faces.empty()) drop_duplicates();
    flat_.insert(flat_.end(), dissolved.faces.begin(), dissolved.faces.end());
    if (loops_.count() == 0) refuse_nothing_left();
    place_vertices();
    tell();
    fill_arrays();
    out_.cut_edges = std::move(dissolved.cut_edges);
    return std::move(out_);
  }

 private:
  bool nothing_wrong() const {
    for (const std::int64_t f : Cancellable(mesh_.face_count())) {
      const auto face = mesh_.face(f);
      if (names_absent_vertex(face, mesh_.vertex_count())) return false;
      if (face.size() < 3 || repeats_a_vertex(face) || has_no_area(mesh_.coordinates, face))
        return false;
    }
    return faces_with_same_vertices(mesh_).empty() &&
           non_finite_vertices(mesh_.coordinates).empty();
  }

  void set_faces() {
    loops_.reserve(std::size_t(mesh_.face_count()), mesh_.corners.size());
    std::vector<MendCorner> walk;
    for (const std::int64_t f : Cancellable(mesh_.face_count())) {
      const auto face = mesh_.face(f);
      if (names_absent_vertex(face, mesh_.vertex_count())) {
        absent_.push_back(f);
        continue;
      }
      walk.clear();
      for (std::size_t i = 0; i < face.size(); ++i) {
        const auto k = Index(mesh_.offsets[f]) + Index(i);
        walk.push_back({merges_.lead(Index(face[i])), {k, k}});
      }
      const std::vector<Loop> loops = simple_loops(walk);
      for (const Loop& loop : loops) loops_.add(loop, Index(f));
      if (face.size() < 3)
        few_.push_back(f);
      else if (repeats_a_vertex(face))
        repeated_.push_back(f);
      else if (loops.empty())
        flat_.push_back(f);
    }
  }

  void drop_duplicates() {
    const OwnedPolygonMesh now = to_arrays(loops_, {});
    const CountedBytes counted(bytes_of(now));
    const PolygonMesh faces{mesh_.coordinates, now.corners, now.offsets};
    const std::vector<SameVertices> same = faces_with_same_vertices(faces);
    if (same.empty()) return;
    Loops kept;
    kept.reserve(loops_.origin.size(), loops_.corners.size());
    auto next = same.begin();
    for (const Index f : Cancellable(loops_.count())) {
      const bool listed = next != same.end() && next->face == f;
      if (listed && next->first != f)
        duplicates_.push_back(loops_.origin[f]);
      else
        kept.add(loops_.face(f), loops_.origin[f]);
      if (listed) ++next;
    }
    loops_ = std::move(kept);
  }

  [[noreturn]] void refuse_nothing_left() const {
    throw FairingError(ErrorCode::no_faces,
                       "No face has an area: the mesh has only points and lines.");
  }

  // Moves unused vertices without a valid position to a used one.
  void place_vertices() {
    out_.vertex_origin.resize(std::size_t(mesh_.vertex_count()));
    for (std::size_t v = 0; v < out_.vertex_origin.size(); ++v) {
      out_.vertex_origin[v] = merges_.lead(Index(v));
      if (out_.vertex_origin[v] != Index(v)) merged_.push_back(std::int64_t(v));
    }
    for (const std::int64_t v : non_finite_vertices(mesh_.coordinates)) {
      out_.vertex_origin[v] = loops_.corners[0].vertex;
      const auto at = mesh_.coordinates.subspan(3 * std::size_t(v), 3);
      (std::ranges::all_of(at, [](double x) { return std::isfinite(x); }) ? far_ : lost_)
          .push_back(v);
    }
  }

  void fill_arrays() {
    out_.mesh = to_arrays(loops_, out_.placed(mesh_.coordinates));
    out_.face_origin.assign(loops_.origin.begin(), loops_.origin.end());
    out_.corner_origin.reserve(loops_.corners.size());
    for (const MendCorner& corner : loops_.corners) out_.corner_origin.push_back(corner.origin);
    const CountedBytes counted(out_.bytes());  // from here on it belongs to the caller
  }

  void add_act(ErrorCode code, ElementKind kind, Ids ids, const char* done) {
    if (ids.empty()) return;
    std::sort(ids.begin(), ids.end());
    ids.erase(std::unique(ids.begin(), ids.end()), ids.end());
    out_.acts.push_back({name(code), done, std::move(ids), kind});
  }

  void tell() {
    const auto faces = [&](ErrorCode code, const Ids& ids, const char* done) {
      add_act(code, ElementKind::face, ids, done);
    };
    const auto vertices = [&](ErrorCode code, const Ids& ids, const char* done) {
      add_act(code, ElementKind::vertex, ids, done);
    };
    faces(ErrorCode::bad_shape, few_,
          "{face} had fewer than three corners and {was|were} dropped.");
    faces(ErrorCode::index_out_of_range, absent_,
          "{face} named {a vertex|vertices} that the mesh does not have and {was|were} dropped.");
    vertices(
        ErrorCode::non_finite, lost_,
        "{vertex} had no finite position and no face, and {was|were} moved to a vertex that has "
        "both.");
    vertices(ErrorCode::non_finite, far_,
             "{vertex} had a coordinate beyond 1e100 and no face, and {was|were} moved to a vertex "
             "that has one.");
    faces(ErrorCode::repeated_vertex, repeated_,
          "{face} named a vertex twice: the doubled {corner was|corners were} dropped.");
    vertices(ErrorCode::coincident_vertices, merged_,
             "{vertex} {was|were} merged with {the vertex|vertices} at the same place.");
    faces(ErrorCode::duplicate_face, duplicates_,
          "{face} had the same vertices as {an earlier one|earlier ones} and {was|were} dropped.");
    faces(ErrorCode::degenerate_face, flat_, "{face} had no area and {was|were} dissolved.");
  }

  const PolygonMesh& mesh_;
  const MendOptions& options_;
  UnionFind merges_;
  Loops loops_;
  Ids few_, absent_, repeated_, flat_, duplicates_, merged_, lost_, far_;
  MendedMesh out_;
};

}  // namespace

std::size_t MendedMesh::bytes() const {
  const auto of = [](const auto& array) { return array.capacity() * sizeof(array[0]); };
  std::size_t bytes =
      bytes_of(mesh) + of(vertex_origin) + of(face_origin) + of(corner_origin) + of(cut_edges);
  for (const CutEdge& edge : cut_edges) bytes += of(edge.between);
  for (const Warning& act : acts) bytes += of(act.elements);
  return bytes;
}

std::vector<double> MendedMesh::placed(std::span<const double> coordinates) const {
  std::vector<double> out(coordinates.begin(), coordinates.end());
  for (std::size_t v = 0; v < vertex_origin.size(); ++v) {
    const auto from = std::size_t(vertex_origin[v]);
    if (from != v) std::copy_n(coordinates.data() + 3 * from, 3, out.data() + 3 * v);
  }
  return out;
}

MendedMesh mend(const PolygonMesh& mesh, const MendOptions& options) {
  require_mendable(mesh);
  return Mender(mesh, options).run();
}

}  // namespace fairing
