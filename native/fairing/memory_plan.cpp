// SPDX-License-Identifier: GPL-3.0-or-later
#include "fairing/memory_plan.h"

#include <algorithm>
#include <cstdio>
#include <limits>
#include <string>

#include "base/error.h"
#include "curvature/level.h"
#include "mesh/double_cover.h"
#include "mesh/half_edges.h"
#include "multigrid/hierarchy.h"
#include "thin_plate/level.h"

namespace fairing {
namespace {

// Numbers of triangles and quads, with edges and vertices.
struct Elements {
  double vertices = 0, edges = 0, triangles = 0, quads = 0;

  void add_face(std::size_t size, double times) {  // a polygon with its fan and its centre
    const auto n = double(size);
    (size == 4 ? quads : triangles) += times * (size > 4 ? n : 1);
    edges += size > 4 ? times * n : 0;
    vertices += size > 4 ? times : 0;
  }
  double sides() const { return 3 * triangles + 4 * quads; }
  double points(int level) const {
    return double(grid_size(std::int64_t(vertices), std::int64_t(edges), std::int64_t(triangles),
                            std::int64_t(quads), level));
  }
};

struct Counts {
  Elements surface;  // of the output
  Elements solved;   // sheets separated, one-sided ones doubled, without vertices that have no face
  Elements unknown;
  double in_large_rings = 0;  // pairs of neighbours at vertices of high valence, which rows contain
};

// Bounds of the peak, up to twice the peaks of tests/python/test_memory.py, in bytes: for a side of
// the control mesh; by energy for a point of each level, for an unknown of a level with a matrix, and
// for one of the largest level that is factored.
constexpr double control_side = 1200;
struct Costs {
  double point, row, factor;
};
constexpr Costs plate_costs{200, 190, 1100}, curvature_costs{520, 700, 1500},
    variation_costs{980, 300, 4000}, flats_costs{200, 190, 3000};
// In addition: for a point, with the limit surface beside the plate, or with the sweeps of the back
// leg; for a factored unknown, with that surface or if control vertices move; for two neighbours of
// a vertex of high valence.
constexpr double surface_beside = 640, second_factor = 1200, pair_of_neighbours = 6;

const Costs& costs_of(const FairOptions& options) {
  if (options.energy == Energy::thin_plate)
    return options.features.flat_faces.empty() ? plate_costs : flats_costs;
  return options.energy == Energy::total_curvature ? curvature_costs : variation_costs;
}

// The hierarchy ends on its first level, if that is small, or on the finest tiny one. Steps to total
// curvature, and plates with flat faces, factor levels that prove hard.
std::size_t most_factored(const FairOptions& options) {
  if (options.energy == Energy::total_curvature) return direct_limit;
  return options.features.flat_faces.empty() ? tiny_level : direct_limit_of_hard;
}

double factored_unknowns(const Counts& c, const FairOptions& options) {
  const bool any_vertex = c.unknown.vertices > 0;
  const double first = c.unknown.points(any_vertex ? 0 : std::min(options.levels, 1)),
               small = double(most_factored(options));
  double out = any_vertex || first <= double(direct_limit) ? first : 0;
  for (int l = 0; l <= options.levels && c.unknown.points(l) <= small; ++l)
    out = std::max(out, c.unknown.points(l));
  return out;
}

double bytes_of(const Counts& c, std::size_t shapes, const FairOptions& options) {
  const Costs& costs = costs_of(options);
  const bool is_plate = options.energy == Energy::thin_plate;
  const bool on_surface = options.interpolation == Interpolation::limit;
  const bool beside = on_surface || options.paper.method == Method::back_leg;
  const bool twice = beside || (is_plate && options.interpolation == Interpolation::approximate);
  double bytes = control_side * c.solved.sides() +
                 double(shapes * sizeof(Vec3)) * c.solved.points(options.levels) +
                 (costs.factor + (twice ? second_factor : 0)) * factored_unknowns(c, options);
  const int pieces =
      is_plate ? ThinPlateLevel::most_pieces(on_surface) : CurvatureLevel::most_pieces;
  for (int l = 0; l <= options.levels; ++l) {
    const double points = c.solved.points(l);
    bytes += (costs.point + (beside ? surface_beside : 0)) * points;
    if (has_matrix(1 << l, std::size_t(points), pieces))
      bytes += costs.row * c.unknown.points(l) + pair_of_neighbours * c.in_large_rings;
  }
  return bytes;
}

RunSize size_of(const Counts& c, std::size_t shapes, const FairOptions& options) {
  const double cells = double(std::int64_t(1) << (2 * options.levels));
  const double bytes = bytes_of(c, shapes, options);
  return {.points = std::int64_t(c.surface.points(options.levels)),
          .solved = std::int64_t(c.solved.points(options.levels)),
          .triangles = std::int64_t(cells * (c.surface.triangles + 2 * c.surface.quads)),
          .bytes = bytes < 0x1p63 ? std::int64_t(bytes) : std::numeric_limits<std::int64_t>::max()};
}

}  // namespace

RunSize predict_size(std::int64_t vertices, std::span<const std::int64_t> corners,
                     std::span<const std::int64_t> offsets, std::size_t shapes,
                     const FairOptions& options) {
  std::vector<std::int64_t> used(corners.begin(), corners.end()), own;
  std::ranges::sort(used);
  used.erase(std::unique(used.begin(), used.end()), used.end());
  for (const std::int64_t v : corners)
    own.push_back(std::ranges::lower_bound(used, v) - used.begin());
  const std::vector<double> places(3 * used.size());
  const PolygonMesh mesh{places, own, offsets};
  const HalfEdges half_edges(mesh);
  const DoubleCover cover = begin_double_cover(mesh, half_edges);
  Counts c;
  c.surface.vertices = double(vertices);
  c.solved.vertices = double(used.size());
  std::vector<double> valence(used.size(), 0);
  for (const std::int64_t v : own) ++valence[v];
  for (const double n : valence)
    if (n > double(most_coupled)) c.in_large_rings += n * n;
  if (options.interpolation == Interpolation::approximate) c.unknown.vertices = c.solved.vertices;
  for (std::int64_t f = 0; f < mesh.face_count(); ++f) {
    const double times = cover.has(std::int32_t(f)) ? 2 : 1;
    c.surface.add_face(mesh.face(f).size(), 1);
    c.solved.add_face(mesh.face(f).size(), times);
    c.unknown.add_face(mesh.face(f).size(), times);
  }
  for (std::int32_t k = 0; k < half_edges.count(); ++k) {
    if (half_edges.twin(k) > k) continue;
    const double times = cover.has(half_edges.face(k)) ? 2 : 1;
    c.surface.edges += 1;
    c.solved.edges += times;
    c.unknown.edges += half_edges.twin(k) < 0 ? 0 : times;
  }
  c.surface.edges -= double(half_edges.sides_at_nonmanifold_edges()) -
                     double(half_edges.nonmanifold_edges().size()) / 2;
  return size_of(c, shapes, options);
}

void require_fit(const RunSize& size, const FairOptions& options) {
  const std::size_t limit = options.bytes_allowed();
  const auto gigabytes = [](double bytes) {
    char text[32];
    std::snprintf(text, sizeof text, "%.3g GB", bytes / 1e9);
    return std::string(text);
  };
  if (limit && size.bytes > std::int64_t(limit))
    throw FairingError(ErrorCode::too_large,
                       {"This takes about " + gigabytes(double(size.bytes)) + " for " +
                            std::to_string(size.triangles) + " triangles, over the limit of " +
                            gigabytes(double(limit)) + ".",
                        "Use fewer levels, or raise memory_limit."});
  constexpr std::int64_t most = std::numeric_limits<std::int32_t>::max();
  if (3 * size.solved > most || 3 * size.triangles > most)
    throw FairingError(ErrorCode::too_large, {std::to_string(size.triangles) +
                                                  " triangles are more than 32-bit ids can name.",
                                              "Use fewer levels."});
}

}  // namespace fairing
