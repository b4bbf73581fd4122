// SPDX-License-Identifier: GPL-3.0-or-later
#include "fairing/mending.h"

#include <algorithm>
#include <type_traits>

#include "fairing/settings.h"
#include "mesh/region.h"
#include "mesh/validate/check.h"
#include "mesh/vertex_pair.h"
#include "parallel/cancel.h"

namespace fairing {
namespace {

using Ids = std::vector<std::int64_t>;

std::vector<VertexPair> edges_of(const PolygonMesh& mesh) {
  std::vector<VertexPair> edges;
  edges.reserve(mesh.corners.size());
  for (const std::int64_t f : Cancellable(mesh.face_count())) {
    const auto face = mesh.face(f);
    for (std::size_t i = 0; i < face.size(); ++i)
      edges.push_back(ascending(face[i], face[(i + 1) % face.size()]));
  }
  std::sort(edges.begin(), edges.end());
  return edges;
}

// Maps edges of the input to edges of the mended mesh.
class NamedEdges {
 public:
  NamedEdges(const PolygonMesh& input, const MendedMesh& mended)
      : mended_(mended), before_(edges_of(input)), after_(edges_of(mended.mesh.view())) {}

  // edges <- their pieces, or none if their faces are gone. A pair that was never an edge is kept,
  // for the core to reject.
  void map(std::vector<VertexPair>& edges) const {
    std::vector<VertexPair> now;
    for (const VertexPair& edge : edges) add(edge, now);
    edges = std::move(now);
  }

 private:
  static bool has(const std::vector<VertexPair>& edges, const VertexPair& edge) {
    return std::binary_search(edges.begin(), edges.end(), edge);
  }

  void add(const VertexPair& edge, std::vector<VertexPair>& out) const {
    const auto count = std::int64_t(mended_.vertex_origin.size());
    const bool inside = std::min(edge[0], edge[1]) >= 0 && std::max(edge[0], edge[1]) < count;
    if (!inside || !has(before_, ascending(edge[0], edge[1])))
      out.push_back(edge);
    else
      add_pieces(mended_.vertex_origin[edge[0]], mended_.vertex_origin[edge[1]], out);
  }

  void add_pieces(std::int64_t a, std::int64_t b, std::vector<VertexPair>& out) const {
    std::vector<VertexPair> waiting{ascending(a, b)};
    // This ends, since every piece is shorter than the whole.
    for (std::size_t i = 0; i < waiting.size(); ++i) {
      const VertexPair edge = waiting[i];
      if (has(after_, edge)) {
        out.push_back(edge);
        continue;
      }
      const auto at = std::lower_bound(mended_.cut_edges.begin(), mended_.cut_edges.end(), edge,
                                       [](const CutEdge& cut, const VertexPair& wanted) {
                                         return VertexPair{cut.low, cut.high} < wanted;
                                       });
      if (at == mended_.cut_edges.end() || VertexPair{at->low, at->high} != edge) continue;
      std::int64_t from = at->low;
      for (const Index v : at->between) {
        waiting.push_back(ascending(from, v));
        from = v;
      }
      waiting.push_back(ascending(from, at->high));
    }
  }

  const MendedMesh& mended_;
  std::vector<VertexPair> before_, after_;
};

MendedMesh mend_as_asked(const PolygonMesh& input, const FairOptions& options) {
  if (options.repair != Repair::mend) return {};
  check_options(input, options);
  return mend(input, {options.weld});
}

}  // namespace

void require_readable(const PolygonMesh& input, Repair repair) {
  if (repair == Repair::mend)
    require_mendable(input);
  else
    require_arrays(input);
}

Mending::Mending(const PolygonMesh& input, const FairOptions& options)
    : mended_(mend_as_asked(input, options)),
      counted_(mended_.changed() ? mended_.bytes() : 0),
      mesh_(input),
      options_(options) {
  if (!mended_.changed()) return;
  mesh_ = mended_.mesh.view();
  map_options(input);
}

void Mending::map_options(const PolygonMesh& input) {
  map_edges(input);
  map_faces(input);
  map_vertex_values(input);
  for (std::int64_t& v : options_.features.corner_vertices)
    if (v >= 0 && v < input.vertex_count()) v = mended_.vertex_origin[v];
  const std::size_t size = input.coordinates.size();
  for (std::size_t s = 0; s < options_.shape_count(size); ++s) {
    const std::vector<double> shape = placed(options_.shapes.subspan(s * size, size));
    shapes_.insert(shapes_.end(), shape.begin(), shape.end());
  }
  options_.shapes = shapes_;
}

void Mending::map_edges(const PolygonMesh& input) {
  FeatureOptions& features = options_.features;
  std::vector<std::vector<VertexPair>*> lists{&features.crease_edges};
  for (std::vector<VertexPair>& of_mode : features.boundary_edges) lists.push_back(&of_mode);
  std::erase_if(lists, [](const std::vector<VertexPair>* list) { return list->empty(); });
  EdgeValues* const weighed[] = {&options_.sharpness.edges, &features.soft_creases};
  if (lists.empty() && weighed[0]->first.empty() && weighed[1]->first.empty()) return;
  const NamedEdges named(input, mended_);
  for (std::vector<VertexPair>* list : lists) named.map(*list);
  for (EdgeValues* const given : weighed) {
    EdgeValues all;
    for (std::size_t k = 0; k < given->first.size(); ++k) {
      std::vector<VertexPair> now{given->first[k]};
      named.map(now);
      all.first.insert(all.first.end(), now.begin(), now.end());
      all.second.resize(all.first.size(), given->second[k]);
    }
    *given = std::move(all);
  }
}

void Mending::map_faces(const PolygonMesh& input) {
  const auto map = [&](std::vector<std::int64_t>& faces, const std::vector<std::uint8_t>& chosen) {
    faces.clear();
    for (std::size_t f = 0; f < mended_.face_origin.size(); ++f)
      if (chosen[mended_.face_origin[f]]) faces.push_back(std::int64_t(f));
  };
  FeatureOptions& features = options_.features;
  if (features.region.given)
    map(features.region.faces, chosen_faces(features.region, input.face_count()));
  map(features.flat_faces, flags_of_faces(features.flat_faces, input.face_count(), "flat_faces"));
}

// Of merged vertices the strictest constraint is used, and the first normal.
void Mending::map_vertex_values(const PolygonMesh& input) {
  const Ids lost = non_finite_vertices(input.coordinates);
  for (std::size_t v = 0; 3 * v < options_.normals.size(); ++v) {
    const auto lead = std::size_t(mended_.vertex_origin[v]);
    if (options_.has_normal(v) && !options_.has_normal(lead))
      std::copy_n(options_.normals.data() + 3 * v, 3, options_.normals.data() + 3 * lead);
  }
  const auto gather = [&](std::vector<double>& values, auto stronger) {
    if (values.size() != mended_.vertex_origin.size()) return;
    for (std::size_t v = 0; v < values.size(); ++v) {
      if (std::binary_search(lost.begin(), lost.end(), std::int64_t(v))) continue;
      double& lead = values[mended_.vertex_origin[v]];
      lead = stronger(lead, values[v]);
    }
  };
  gather(options_.tolerance, [](double a, double b) { return std::min(a, b); });
  for_each_setting([&](const char*, auto range, auto... member) {
    if constexpr (std::is_same_v<decltype(range), PerVertex>)
      gather((options_.*....*member), [](double a, double b) { return std::max(a, b); });
  });
}

void Mending::restore_points(double* world) const {
  for (std::size_t v = 0; v < mended_.vertex_origin.size(); ++v) {
    const auto from = std::size_t(mended_.vertex_origin[v]);
    if (from != v) std::copy_n(world + 3 * from, 3, world + 3 * v);
  }
}

void Mending::restore(OutputFaces& faces) const {
  if (!mended_.changed()) return;
  const auto restore_polygons = [&](Array<std::int32_t>& polygons, Array<std::int32_t>& mended) {
    mended = polygons;
    for (std::int32_t& f : polygons) f = mended_.face_origin[f];
  };
  restore_polygons(faces.triangle_polygon, faces.triangle_mended);
  restore_polygons(faces.quad_polygon, faces.quad_mended);
}

void Mending::restore(Report& report) const {
  report.flipped_faces = faces_of_input(report.flipped_faces);
  restore(report.warnings);
  give_to_merged(mended_.vertex_origin, report.pads.widths);
  report.repairs = mended_.acts;
  if (options_.repair == Repair::mend && !report.flipped_faces.empty())
    report.repairs.push_back({name(ErrorCode::inconsistent_orientation),
                              "{face} pointed against the neighbours and {was|were} flipped.",
                              report.flipped_faces, ElementKind::face});
}

// Merged vertices have no face, but are not isolated.
void Mending::restore(std::vector<Warning>& warnings) const {
  if (!mended_.changed()) return;
  for (Warning& warning : warnings) {
    if (warning.kind == ElementKind::face)
      warning.elements = faces_of_input(warning.elements);
    else if (warning.code == name(ErrorCode::isolated_vertices))
      std::erase_if(warning.elements,
                    [&](std::int64_t v) { return mended_.vertex_origin[v] != Index(v); });
  }
  std::erase_if(warnings, [](const Warning& warning) {
    return warning.elements.empty() && warning.kind != ElementKind::mesh;
  });
}

Ids Mending::faces_of_input(std::span<const std::int64_t> faces) const {
  Ids ids(faces.begin(), faces.end());
  if (!mended_.changed()) return ids;
  for (std::int64_t& f : ids) f = mended_.face_origin[f];
  std::sort(ids.begin(), ids.end());
  ids.erase(std::unique(ids.begin(), ids.end()), ids.end());
  return ids;
}

FairingError Mending::restored(const FairingError& error) const {
  if (!mended_.changed() || error.kind != ElementKind::face) return error;
  return {error.code, error.message, faces_of_input(error.elements), error.kind};
}

}  // namespace fairing
