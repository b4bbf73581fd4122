// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/symmetry.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "parallel/cancel.h"

namespace fairing {
namespace {

// Most searches for a vertex over all candidate planes; more give up the symmetry.
constexpr std::size_t most_searches = 64;

// Finds the vertex at a place, without copies. Vertices with faces are sorted along a direction
// that no mesh is aligned with.
class PointSearch {
 public:
  explicit PointSearch(const ControlMesh& mesh);

  static constexpr Index none = -1, several = -2;

  // The only vertex within `tolerance` of p.
  Index at(const Vec3& p, double tolerance) const;

 private:
  struct Entry {
    double key;
    Index vertex;
  };
  const std::vector<Vec3>& positions_;
  std::vector<Entry> entries_;
};

// Coordinate along that direction.
double key_of(const Vec3& p) {
  static const Vec3 along = Vec3(std::numbers::e, std::numbers::pi, std::numbers::phi).normalized();
  return p.dot(along);
}

PointSearch::PointSearch(const ControlMesh& mesh) : positions_(mesh.positions) {
  for (Index v = 0; v < mesh.vertex_count(); ++v)
    if (!mesh.ring(v).empty() && mesh.original_vertex(v) == v)
      entries_.push_back({key_of(positions_[v]), v});
  std::sort(entries_.begin(), entries_.end(),
            [comparisons = std::size_t(0)](const Entry& a, const Entry& b) mutable {
              stop_if_cancelled(++comparisons);
              return a.key < b.key;
            });
}

Index PointSearch::at(const Vec3& p, double tolerance) const {
  const double key = key_of(p), span = 2 * tolerance;
  auto entry = std::lower_bound(entries_.begin(), entries_.end(), key - span,
                                [](const Entry& e, double k) { return e.key < k; });
  Index found = none;
  for (; entry != entries_.end() && entry->key <= key + span; ++entry) {
    if ((positions_[entry->vertex] - p).norm() > tolerance) continue;
    if (found >= 0) return several;
    found = entry->vertex;
  }
  return found;
}

// The side from a to b; -1: none.
Index side_between(const ControlMesh& mesh, Index a, Index b) {
  const bool at_a = mesh.ring(a).size() <= mesh.ring(b).size();
  for (const Spoke& spoke : mesh.ring(at_a ? a : b)) {
    if (mesh.end_of(spoke) == (at_a ? b : a))
      return mesh.edges[spoke.edge].side[spoke.outward == at_a ? 0 : 1];
  }
  return -1;
}

template <class T>
bool same(const std::vector<T>& values, const std::vector<Index>& image) {
  for (std::size_t i = 0; i < values.size(); ++i)
    if (values[i] != values[image[i]]) return false;
  return true;
}

class MirrorFinder {
 public:
  MirrorFinder(const ControlMesh& mesh, double tolerance)
      : mesh_(mesh),
        tolerance_(tolerance),
        search_(mesh),
        searches_(most_searches * std::size_t(mesh.vertex_count())) {}

  bool exhausted() const { return searches_ == 0; }

  bool find(const Plane& plane, Mirror& mirror) {
    mirror.plane = plane;
    if (!map_vertices(mirror)) return false;
    centre_plane(mirror);
    return mirrors_positions(mesh_, mirror, mesh_.positions, tolerance_) && map_faces(mirror) &&
           maps_features(mirror);
  }

 private:
  bool map_vertices(Mirror& mirror) {
    std::vector<Index>& image = mirror.vertex;
    image.resize(std::size_t(mesh_.vertex_count()));
    std::vector<Index> unclear;
    for (const Index v : Cancellable(mesh_.vertex_count())) {
      image[v] = v;
      if (mesh_.ring(v).empty()) continue;
      if (searches_ == 0) return false;
      --searches_;
      const Vec3 opposite = mirror.plane.image(mesh_.positions[v]);
      const Index found = image[v] = search_.at(opposite, Plane::search_reach * tolerance_);
      if (found == PointSearch::none) return false;
      if (found == PointSearch::several) unclear.push_back(v);
    }
    if (!distinguish_copies(image)) return false;
    distinguish(std::move(unclear), image);
    const auto is_centre = [&](Index v) { return v >= mesh_.first_centre(); };
    for (Index v = 0; v < mesh_.vertex_count(); ++v) {
      const Index other = image[v];
      if (other < 0 || image[other] != v) return false;
      if (is_centre(other) != is_centre(v)) return false;
    }
    return true;
  }

  // Where sheets meet, `image` still has input vertices: the face of the sheet determines the copy.
  bool distinguish_copies(std::vector<Index>& image) const {
    if (mesh_.copies.vertex.empty()) return true;
    const std::vector<Index> originals = image;
    for (const Index v : Cancellable(mesh_.vertex_count())) {
      if (originals[v] < 0 || !mesh_.shared(v) || mesh_.ring(v).empty()) continue;
      const Spoke& spoke = mesh_.ring(v)[0];
      const Face& face = mesh_.faces[spoke.face];
      if (lies_in_plane(face, originals)) {
        image[v] = v;
        continue;
      }
      Index& found = image[v] = -1;
      mesh_.for_each_copy(originals[v], [&](Index w) {
        for (const Spoke& other : mesh_.ring(w))
          if (other.face >= 0 && faces_match(face, spoke.corner, other, originals)) found = w;
      });
      if (found < 0) return false;
    }
    return true;
  }

  // Whether a face is its own image. Then the whole sheet lies in the plane: if a face left the
  // plane, its image would be a third face at the edge. Only where sheets meet does a surface have
  // such a part and another one.
  bool lies_in_plane(const Face& face, const std::vector<Index>& image) const {
    return !mesh_.copies.vertex.empty() && std::ranges::all_of(corners(face), [&](Index v) {
      return mesh_.original_vertex(image[v]) == mesh_.original_vertex(v);
    });
  }

  // Whether the face at `other` is the image of `face`, and its corner that of `corner`.
  bool faces_match(const Face& face, int corner, const Spoke& other,
                   const std::vector<Index>& image) const {
    const Face& mirrored = mesh_.faces[other.face];
    if (mirrored.size != face.size) return false;
    for (int i = 0; i < face.size; ++i) {
      const Index v = face.vertex[(corner + i) % face.size],
                  w = mirrored.vertex[(other.corner + face.size - i) % face.size];
      if (image[v] != mesh_.original_vertex(w)) return false;
    }
    return true;
  }

  // Uses faces to distinguish vertices at one place.
  void distinguish(std::vector<Index> unclear, std::vector<Index>& image) const {
    while (!unclear.empty()) {
      const Index v = unclear.back();
      unclear.pop_back();
      if (image[v] >= 0) continue;
      const Index found = image[v] = image_by_faces(v, image);
      if (found < 0) continue;
      for (const Spoke& spoke : mesh_.ring(v)) {
        if (spoke.face < 0) continue;
        for (const Index other : corners(mesh_.faces[spoke.face]))
          if (image[other] < 0) unclear.push_back(other);
      }
    }
  }

  Index image_by_faces(Index v, const std::vector<Index>& image) const {
    for (const Spoke& spoke : mesh_.ring(v)) {
      if (spoke.face < 0) continue;
      const Face& face = mesh_.faces[spoke.face];
      for (int c = 0; c < face.size; ++c) {
        const FaceImage found = face_image(face, c, image);
        if (found.face >= 0) return mesh_.faces[found.face].vertex[corner(found, spoke.corner)];
      }
    }
    return PointSearch::several;
  }

  // Fits the plane to all pairs; coordinate planes are exact.
  void centre_plane(Mirror& mirror) const {
    Plane& plane = mirror.plane;
    if (plane.offset == 0 && plane.normal.cwiseAbs().maxCoeff() == 1) return;
    Vec3 sum = Vec3::Zero();
    for (std::size_t v = 0; v < mirror.vertex.size(); ++v) {
      const Vec3 between = mesh_.positions[v] - mesh_.positions[mirror.vertex[v]];
      sum += plane.normal.dot(between) > 0 ? between : Vec3(-between);
    }
    if (sum.norm() > 0) plane.normal = sum.normalized();
    double offset = 0, count = 0;
    for (Index v = 0; v < mesh_.vertex_count(); ++v) {
      if (mesh_.ring(v).empty()) continue;
      offset += plane.normal.dot(mesh_.positions[v]);
      ++count;
    }
    plane.offset = offset / count;
  }

  struct FaceImage {
    Index face = -1;
    int size = 0, turn = 0;
  };

  std::span<const Index> corners(const Face& face) const {
    return {face.vertex.data(), std::size_t(face.size)};
  }

  static std::size_t corner(const FaceImage& image, int c) {
    return std::size_t((image.turn - c + image.size) % image.size);
  }

  // A face's image has the opposite orientation: side c, from a to b, becomes that from b' to a'.
  FaceImage face_image(const Face& face, int c, const std::vector<Index>& image) const {
    const Index a = image[face.vertex[c]], b = image[face.vertex[(c + 1) % face.size]];
    const Index found = a < 0 || b < 0 ? -1 : side_between(mesh_, b, a);
    if (found < 0) return {};
    const Side& side = mesh_.sides[found];
    if (mesh_.faces[side.face].size != face.size) return {};
    return {side.face, face.size, (side.local + 1 + c) % face.size};
  }

  bool map_faces(Mirror& mirror) const {
    mirror.edge.resize(mesh_.edges.size());
    mirror.face.resize(mesh_.faces.size());
    mirror.turn.resize(mesh_.faces.size());
    for (const std::size_t f : Cancellable(mesh_.faces.size())) {
      const Face& face = mesh_.faces[f];
      if (lies_in_plane(face, mirror.vertex)) {
        for (int c = 0; c < face.size; ++c) {
          const Index e = mesh_.sides[face.first_side + c].edge;
          mirror.edge[e] = e;
        }
        mirror.face[f] = Index(f);
        mirror.turn[f] = Mirror::in_plane;
        continue;
      }
      const FaceImage image = face_image(face, 0, mirror.vertex);
      if (image.face < 0) return false;
      const Face& other = mesh_.faces[image.face];
      for (int c = 0; c < face.size; ++c) {
        if (other.vertex[corner(image, c)] != mirror.vertex[face.vertex[c]]) return false;
        const Index side = other.first_side + Index(corner(image, (c + 1) % face.size));
        mirror.edge[mesh_.sides[face.first_side + c].edge] = mesh_.sides[side].edge;
      }
      mirror.face[f] = image.face;
      mirror.turn[f] = std::int8_t(image.turn);
    }
    return true;
  }

  bool maps_features(const Mirror& mirror) const {
    const Region& region = mesh_.region;
    return same(mesh_.feature_vertex, mirror.vertex) && same(mesh_.feature_edge, mirror.edge) &&
           same(region.vertex, mirror.vertex) && same(region.edge, mirror.edge) &&
           same(region.face, mirror.face) && same(region.clamped_vertex, mirror.vertex) &&
           same(region.clamped_edge, mirror.edge) && same(mesh_.soft.edge, mirror.edge) &&
           same(mesh_.flat.face, mirror.face) && same_directions(mirror);
  }

  // Whether the image of every straight face is straight: then it is so in the image's direction.
  bool same_directions(const Mirror& mirror) const {
    for (std::size_t f = 0; f < mesh_.flat.along.size(); ++f)
      if (mesh_.flat.is_straight(Index(f)) != mesh_.flat.is_straight(mirror.face[f])) return false;
    return true;
  }

  const ControlMesh& mesh_;
  double tolerance_;
  PointSearch search_;
  std::size_t searches_;
};

}  // namespace

bool mirrors_positions(const ControlMesh& mesh, const Mirror& mirror,
                       std::span<const Vec3> positions, double tolerance) {
  for (const std::size_t v : Cancellable(positions.size())) {
    if (mesh.ring(Index(v)).empty()) continue;
    const Vec3& opposite = positions[mirror.vertex[v]];
    if ((mirror.plane.image(positions[v]) - opposite).norm() > tolerance) return false;
  }
  return true;
}

Symmetry Symmetry::kept(const Holds& holds) const {
  Symmetry out;
  for (const auto& mirror : mirrors)
    if (holds(*mirror)) out.mirrors.push_back(mirror);
  return out;
}

std::vector<Index> Symmetry::images(Index v) const {
  std::vector<Index> out{v};
  for (const auto& mirror : mirrors)
    for (std::size_t k = 0, known = out.size(); k < known; ++k) {
      const Index image = mirror->vertex[out[k]];
      if (std::ranges::find(out, image) == out.end()) out.push_back(image);
    }
  return out;
}

Symmetry find_symmetry(const ControlMesh& mesh, double tolerance, const Symmetry::Holds& holds) {
  Symmetry found;
  const std::vector<Plane> planes = mirror_planes(mesh, tolerance);
  if (planes.empty()) return found;
  MirrorFinder finder(mesh, tolerance);
  for (const Plane& plane : planes) {
    if (found.mirrors.size() == 3 || finder.exhausted()) break;
    const auto is_right = [&](const auto& other) {
      return std::abs(other->plane.normal.dot(plane.normal)) <= Plane::search_reach * tolerance;
    };
    if (!std::ranges::all_of(found.mirrors, is_right)) continue;
    Mirror mirror;
    if (finder.find(plane, mirror) && holds(mirror))
      found.mirrors.push_back(std::make_shared<const Mirror>(std::move(mirror)));
  }
  return found;
}

}  // namespace fairing
