// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/fill/fill.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <limits>
#include <map>
#include <set>

#include "base/error.h"
#include "base/roundoff.h"
#include "mesh/fill/rims.h"
#include "mesh/fill/ruled.h"
#include "parallel/cancel.h"

namespace fairing {
namespace {

// Sweeps that smooth the requested lengths along a ragged rim.
constexpr int length_sweeps = 2;

FairingError coincide(std::vector<std::int64_t> ids) {
  std::sort(ids.begin(), ids.end());
  return FairingError(
      ErrorCode::coincident_vertices,
      {"{vertex} of the rim coincide; the hole has no width there.", "Merge them by distance."},
      ids);
}

// The first triangles of one hole. It numbers the vertices of its loops, one loop after another.
class OneHole {
 public:
  OneHole(const Hole& hole, Rims& rims) : rims_(rims) {
    for (const HoleLoop& loop : hole) {
      begin_.push_back(ids_.size());
      ids_.insert(ids_.end(), loop.begin(), loop.end());
    }
    begin_.push_back(ids_.size());
  }

  const std::vector<std::int64_t>& ids() const { return ids_; }

  // A patch with the points of all loops, and without triangles.
  Patch rim(double density) const {
    Patch patch;
    patch.rim = Index(ids_.size());
    for (const std::int64_t v : ids_) patch.points.push_back(rims_.point(v));
    patch.lengths.resize(ids_.size());
    patch.rim_normals.resize(ids_.size());
    for (std::size_t l = 0; l + 1 < begin_.size(); ++l) {
      for (std::size_t i = begin_[l]; i < begin_[l + 1]; ++i) {
        patch.rim_normals[i] = rims_.normal_beside(ids_[after(i, l)], ids_[i]);
        patch.lengths[i] = ((patch.points[i] - patch.points[after(i, l)]).norm() +
                            (patch.points[i] - patch.points[before(i, l)]).norm()) /
                           (2 * (density > 0 ? density : 1));
      }
      for (int sweep = 0; sweep < length_sweeps; ++sweep) even_out(patch.lengths, l);
    }
    return patch;
  }

  // Rejects a rim that returns along itself, as at the seams of a file that has their vertices twice.
  void require_width(const Patch& rim) const {
    using Point = std::array<double, 3>;
    std::map<std::pair<Point, Point>, std::size_t> sides;
    const auto point = [&](std::size_t i) {
      return Point{rim.points[i][0], rim.points[i][1], rim.points[i][2]};
    };
    for (std::size_t l = 0; l + 1 < begin_.size(); ++l)
      for (std::size_t i = begin_[l]; i < begin_[l + 1]; ++i) {
        const std::size_t next = after(i, l);
        const auto [other, is_first] = sides.try_emplace(std::minmax(point(i), point(next)), i);
        const std::size_t twin = other->second;
        if (!is_first) throw coincide({ids_[twin], ids_[point(twin) == point(i) ? i : next]});
      }
  }

  // Returns how refine() may move new points: between two rims taut triangles would shrink to a waist.
  Relaxation triangulate_into(Patch& patch, bool bends) {
    const auto may_join = [&](std::size_t a, std::size_t b) { return !joined(Index(a), Index(b)); };
    const bool has_two_rims = begin_.size() == 3;
    if (has_two_rims && fill_ring(patch, begin_[1], bends, may_join)) return Relaxation::sliding;
    triangulate_walk_into(patch);
    return Relaxation::taut;
  }

  bool joined(Index a, Index b) const { return rims_.are_joined(ids_[a], ids_[b]); }

 private:
  // Two places of the walk, the lower one first.
  using Chord = std::pair<std::size_t, std::size_t>;

  // The walk passes some vertices more than once if there are islands. So a triangulation of its
  // places may join two vertices by two edges; then the second one is forbidden, and the walk is
  // triangulated again, at most once for each place.
  void triangulate_walk_into(Patch& patch) {
    walk_all(patch.points);
    for (std::size_t tries = 0; tries < walk_.size(); ++tries) {
      const std::vector<Triangle> found = triangulate(polygon(patch.points));
      if (found.empty()) break;
      if (forbids_second_edges(found)) continue;
      for (const Triangle& t : found)
        patch.triangles.push_back({walk_[t[0]], walk_[t[1]], walk_[t[2]]});
      return;
    }
    fan_into(patch);
  }

  std::size_t after(std::size_t i, std::size_t l) const {
    return i + 1 == begin_[l + 1] ? begin_[l] : i + 1;
  }
  std::size_t before(std::size_t i, std::size_t l) const {
    return i == begin_[l] ? begin_[l + 1] - 1 : i - 1;
  }

  void even_out(std::vector<double>& lengths, std::size_t l) const {
    std::vector<double> even;
    for (std::size_t i = begin_[l]; i < begin_[l + 1]; ++i)
      even.push_back((lengths[before(i, l)] + 2 * lengths[i] + lengths[after(i, l)]) / 4);
    std::copy(even.begin(), even.end(), lengths.begin() + begin_[l]);
  }

  // Makes one walk around the outer loop and all islands. A bridge leads to each island and back, from
  // the nearest vertex of the walk so far; the nearest island comes first.
  void walk_all(const std::vector<Vec3>& points) {
    walk_.clear();
    for (std::size_t i = 0; i < begin_[1]; ++i) walk_.push_back(Index(i));
    std::vector<std::uint8_t> reached(begin_.size() - 1, 0);
    reached[0] = 1;
    for (std::size_t left = begin_.size() - 2; left > 0; --left) {
      double least = std::numeric_limits<double>::infinity();
      std::size_t place = 0, shore = 0, island = 0;
      for (std::size_t l = 1; l + 1 < begin_.size(); ++l) {
        if (reached[l]) continue;
        for (const std::size_t p : Cancellable(walk_.size())) {
          for (std::size_t i = begin_[l]; i < begin_[l + 1]; ++i) {
            const double distance = (points[walk_[p]] - points[i]).squaredNorm();
            if (distance >= least || joined(walk_[p], Index(i))) continue;
            least = distance, place = p, shore = i, island = l;
          }
        }
      }
      if (island == 0) no_surface();
      bridge(place, shore, island);
      reached[island] = 1;
    }
  }

  // Inserts behind a place: the island from its vertex `shore` all around, and the way back.
  void bridge(std::size_t place, std::size_t shore, std::size_t island) {
    std::vector<Index> detour;
    std::size_t i = shore;
    do {
      detour.push_back(Index(i));
      i = after(i, island);
    } while (i != shore);
    detour.push_back(Index(shore));
    detour.push_back(walk_[place]);
    bridges_.insert(std::minmax(walk_[place], Index(shore)));
    walk_.insert(walk_.begin() + std::ptrdiff_t(place) + 1, detour.begin(), detour.end());
  }

  SpacePolygon polygon(const std::vector<Vec3>& points) const {
    SpacePolygon found;
    for (std::size_t p = 0; p < walk_.size(); ++p) {
      const Index a = walk_[p], b = walk_[(p + 1) % walk_.size()];
      found.points.push_back(points[a]);
      const bool is_bridge = bridges_.contains(std::minmax(a, b));
      found.normals.push_back(is_bridge ? Vec3(Vec3::Zero())
                                        : rims_.normal_beside(ids_[b], ids_[a]));
    }
    found.may_join = [this](std::size_t low, std::size_t high) {
      const Index a = walk_[low], b = walk_[high];
      return a != b && !joined(a, b) && !bridges_.contains(std::minmax(a, b)) &&
             !forbidden_.contains({low, high});
    };
    return found;
  }

  // Forbids the second chord between two vertices. Returns whether there is any.
  bool forbids_second_edges(const std::vector<Triangle>& triangles) {
    std::map<std::pair<Index, Index>, Chord> first;  // by its vertices
    const std::size_t before = forbidden_.size();
    for (const Triangle& t : triangles)
      for (const auto& [low, high] : {std::pair(t[0], t[1]), {t[1], t[2]}, {t[0], t[2]}}) {
        const bool is_side = high == low + 1 || (low == 0 && high + 1 == Index(walk_.size()));
        if (is_side) continue;
        const Chord chord(low, high);
        const auto [known, is_new] = first.try_emplace(std::minmax(walk_[low], walk_[high]), chord);
        if (!is_new && known->second != chord) forbidden_.insert(chord);
      }
    return forbidden_.size() > before;
  }

  // If every triangulation would double an edge of the mesh: a fan around a central vertex.
  void fan_into(Patch& patch) const {
    if (begin_.size() > 2) no_surface();
    const auto size = ids_.size();
    Vec3 middle = Vec3::Zero();
    double length = 0;
    for (std::size_t i = 0; i < size; ++i) {
      middle += patch.points[i] / double(size);
      length += patch.lengths[i] / double(size);
    }
    patch.points.push_back(middle);
    patch.lengths.push_back(length);
    for (std::size_t i = 0; i < size; ++i)
      patch.triangles.push_back({Index(i), Index((i + 1) % size), Index(size)});
  }

  [[noreturn]] void no_surface() const {
    throw FairingError(
        ErrorCode::bad_option,
        {"The islands cannot be joined to the rim at {vertex}.", "Fill the hole without them."},
        {ids_[0]}, ElementKind::vertex);
  }

  Rims& rims_;
  std::vector<std::int64_t> ids_;
  std::vector<std::size_t> begin_;             // by loop, and the end
  std::vector<Index> walk_;                    // vertices, place by place
  std::set<std::pair<Index, Index>> bridges_;  // between vertices
  std::set<Chord> forbidden_;
};

// Calls use(a, b) for the sides of `triangles` between two vertices of the mesh, whose ids are below
// `end`.
template <class Use>
void for_sides_in_mesh(const std::vector<Triangle>& triangles, std::int64_t end, const Use& use) {
  for (const Triangle& t : triangles)
    for (std::size_t i = 0; i < 3; ++i)
      if (t[i] < end && t[(i + 1) % 3] < end) use(t[i], t[(i + 1) % 3]);
}

// Numbers its own vertices from `first` on.
FilledHole numbered(const Patch& patch, const OneHole& hole, std::int64_t first) {
  FilledHole filled;
  const auto rim = std::size_t(patch.rim);
  filled.points.assign(patch.points.begin() + patch.rim, patch.points.end());
  filled.lengths.assign(patch.lengths.begin() + patch.rim, patch.lengths.end());
  const auto id = [&](Index v) {
    const auto i = std::size_t(v);
    return i < rim ? hole.ids()[i] : first + std::int64_t(i - rim);
  };
  if (first + std::int64_t(filled.points.size()) > std::numeric_limits<Index>::max())
    throw FairingError(ErrorCode::too_large, "The mesh would have too many vertices.");
  for (const Triangle& t : patch.triangles)
    filled.triangles.push_back({Index(id(t[0])), Index(id(t[1])), Index(id(t[2]))});
  return filled;
}

void refine_patch(Patch& patch, const OneHole& hole, const FillOptions& options,
                  Relaxation relaxation) {
  if (options.density > 0)
    refine(patch, [&](Index a, Index b) { return hole.joined(a, b); }, relaxation);
}

// Rejects a rim that returns along itself, with no area between.
void require_areas(const Patch& patch, const OneHole& hole) {
  for (const Triangle& t : patch.triangles) {
    Vec3 sides[3];
    std::size_t longest = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      sides[i] = patch.points[t[(i + 1) % 3]] - patch.points[t[i]];
      if (sides[i].squaredNorm() > sides[longest].squaredNorm()) longest = i;
    }
    const double area = sides[0].cross(sides[1]).norm();
    if (area > 2 * roundoff * sides[longest].squaredNorm()) continue;  // as in validate/
    std::vector<std::int64_t> ids;
    for (std::size_t i = 0; i < 3; ++i)
      if (const Index a = t[i], b = t[(i + 1) % 3];
          sides[i].isZero() && a < patch.rim && b < patch.rim)
        ids = {hole.ids()[a], hole.ids()[b]};
    if (!ids.empty()) throw coincide(ids);
    if (const Index middle = t[(longest + 2) % 3]; middle < patch.rim) ids = {hole.ids()[middle]};
    throw FairingError(
        ErrorCode::degenerate_face,
        {"{vertex} of the rim {lies|lie} on another edge of it; the hole has no width there.",
         "Cut that edge at the vertex."},
        ids, ElementKind::vertex);
  }
}

FilledHole fill_one(const Hole& hole, Rims& rims, const FillOptions& options, std::int64_t first) {
  OneHole one(hole, rims);
  Patch patch = one.rim(options.density);
  one.require_width(patch);
  const Relaxation relaxation = one.triangulate_into(patch, options.bends && options.density > 0);
  refine_patch(patch, one, options, relaxation);
  require_areas(patch, one);
  return numbered(patch, one, first);
}

}  // namespace

std::vector<FilledHole> fill(const PolygonMesh& mesh, const HalfEdges& half_edges,
                             std::span<const Hole> holes, const FillOptions& options,
                             Refusals& refusals) {
  Rims rims(mesh, half_edges, holes);
  std::vector<FilledHole> filled;
  std::int64_t next = mesh.vertex_count();
  for (std::size_t h = 0; h < holes.size(); ++h) {
    if (refusals[h]) continue;
    try {
      filled.push_back(fill_one(holes[h], rims, options, next));
    } catch (const FairingError& error) {
      if (error.code == ErrorCode::cancelled) throw;
      refusals[h] = error;
      continue;
    }
    for_sides_in_mesh(filled.back().triangles, mesh.vertex_count(),
                      [&](auto a, auto b) { rims.join(a, b); });
    next += std::int64_t(filled.back().points.size());
  }
  return filled;
}

void refine_again(const PolygonMesh& mesh, const HalfEdges& half_edges, std::span<const Hole> holes,
                  const FillOptions& options, std::span<const std::uint8_t> chosen,
                  std::span<const std::uint8_t> fair, std::vector<FilledHole>& filled) {
  Rims rims(mesh, half_edges, holes);
  const std::int64_t count = mesh.vertex_count();
  for (const FilledHole& hole : filled)
    for_sides_in_mesh(hole.triangles, count, [&](auto a, auto b) { rims.join(a, b); });
  std::int64_t before = count, next = count;
  for (std::size_t h = 0; h < holes.size(); ++h) {
    OneHole one(holes[h], rims);
    Patch patch = one.rim(options.density);
    std::map<std::int64_t, Index> own;
    for (std::size_t i = 0; i < one.ids().size(); ++i) own[one.ids()[i]] = Index(i);
    patch.points.insert(patch.points.end(), filled[h].points.begin(), filled[h].points.end());
    patch.lengths.insert(patch.lengths.end(), filled[h].lengths.begin(), filled[h].lengths.end());
    for (const Triangle& t : filled[h].triangles) {
      Triangle local;
      for (std::size_t i = 0; i < 3; ++i)
        local[i] = t[i] < count ? own.at(t[i]) : Index(patch.rim + (std::int64_t(t[i]) - before));
      patch.triangles.push_back(local);
    }
    before += std::int64_t(filled[h].points.size());
    if (chosen[h]) {
      for_sides_in_mesh(filled[h].triangles, count, [&](auto a, auto b) { rims.part(a, b); });
      refine_patch(patch, one, options, fair[h] ? Relaxation::curved : Relaxation::sliding);
    }
    filled[h] = numbered(patch, one, next);
    for_sides_in_mesh(filled[h].triangles, count, [&](auto a, auto b) { rims.join(a, b); });
    next += std::int64_t(filled[h].points.size());
  }
}

}  // namespace fairing
