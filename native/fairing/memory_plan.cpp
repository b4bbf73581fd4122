// SPDX-License-Identifier: GPL-3.0-or-later
#include "fairing/memory_plan.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <string>

#include "base/error.h"
#include "fairing/memory_counts.h"
#include "multigrid/hierarchy.h"
#include "sparse/matrix.h"

namespace fairing {
namespace {

// Bytes of a vector in space, in double and in single precision, and of an index.
constexpr std::int64_t vector_bytes = 24, float_vector_bytes = 12, index_bytes = 4;

// Between what triangles and what quads take, by the points inside them.
std::int64_t mixed(const Counts& c, double triangle, double quad) {
  const double quads = double(c.quads), all = quads + 0.5 * double(c.triangles);
  return std::int64_t(triangle + (all > 0 ? quads / all : 0) * (quad - triangle)) + 1;
}

// Bytes a point of the smoother's lines (multigrid/line_jacobi.h): most points may be on one.
constexpr std::int64_t line_bytes = 28;

// The assembled matrices of the thin plate, on levels with small faces, and those of the transfers
// between them. Bytes an unknown, measured: equal rows along edges and inside faces share their
// numbers, so that they fall with the pieces of an edge.
std::int64_t matrix_bytes(const Counts& c, int levels) {
  // of triangles and of quads, by levels from the first
  constexpr double row[2][4] = {{80, 125, 90, 66}, {108, 146, 112, 82}},
                   transfer[2][4] = {{80, 88, 97, 60}, {100, 115, 108, 63}};
  const double differing = c.thin ? 1.15 : 1;  // rows of thin faces have fewer numbers in common
  std::int64_t bytes = 0;
  for (int l = 1; l <= std::min(levels, 4); ++l) {
    if (!has_rows(1 << l, std::size_t(c.points(l)))) continue;
    const double below = l > c.base(levels) ? 1 : 0;  // there is a level to transfer to
    bytes += c.in_large_rings * std::int64_t(sizeof(float) + sizeof(RowChunk::LocalColumn));
    bytes += (mixed(c, differing * row[0][l - 1] + below * transfer[0][l - 1],
                    differing * row[1][l - 1] + below * transfer[1][l - 1]) +
              line_bytes) *
             c.unknowns(l);
  }
  return bytes;
}

// Numbers a column of a plate's factor. Measured on some 60 levels of 90 to 1,200 unknowns: minimum
// degree leaves fewer where faces have few points, and the fixed corners among them part the rest.
double columns_of_plate(const Counts& c, int level, double unknowns) {
  if (unknowns > double(tiny_level))
    return double(factor_bytes(std::size_t(unknowns))) / (double(matrix_entry) * unknowns);
  const double doublings = std::log2(std::max(unknowns, 2.0));
  const double entries = double(mixed(c, 100 * doublings - 250, 100 * doublings - 180)) / 10;
  const double few = level > 2 ? 1 : 0.9;  // the share that few points a face leave
  return std::max(2.0, std::min(few * entries, 1 + unknowns / 2));
}

// The factor of a level, part by part. Borders and curves leave fewer neighbours: half as many where
// all edges are such.
std::int64_t plate_factor_bytes(const Counts& c, int level) {
  const auto all = double(c.unknowns(level));
  const double open = 0.5 + 0.5 * double(c.free_edges) / double(std::max<std::int64_t>(c.edges, 1));
  double numbers = 0;
  for (const std::int64_t faces : c.parts) {
    const double unknowns = all * double(faces) / double(c.faces());
    numbers += unknowns * columns_of_plate(c, level, unknowns);
  }
  return std::int64_t(open * numbers * double(matrix_entry));
}

// What Gauss-Newton steps hold beside the thin plate's systems. Bytes a point: on all levels the
// rows of the Jacobian and the smoother's lines, and for minimum variation as many rows again and
// moments; on levels that have rows the normal matrix; on the finest level surfaces, steps,
// and what steps are accelerated with.
std::int64_t step_bytes(const Counts& c, int levels, std::int64_t all_points, Energy energy,
                        bool tense) {
  constexpr std::int64_t moment_bytes = 112, surface_bytes = 480;  // bytes a point
  const bool varies = energy == Energy::minimum_variation;
  const std::int64_t row = mixed(c, 84, 108), normal_matrix = mixed(c, 486, 624);
  std::int64_t normal_matrices = 0, factored = 0;
  for (int l = 0; l <= levels; ++l) {
    if (has_rows(1 << l, std::size_t(c.used_points(l))))
      normal_matrices += normal_matrix * c.used_points(l);
    if (c.unknowns(l) <= std::int64_t(l > 1 ? tiny_level : direct_limit))
      factored = c.used_points(l);
  }
  const std::int64_t rows =
      row + line_bytes + (varies ? row + moment_bytes : 0) + (tense ? row / 3 : 0);
  return rows * all_points + normal_matrices + surface_bytes * c.points(levels) +
         2 * std::int64_t(factor_bytes(std::size_t(factored)));
}

// The peak of a run: while it solves, or at its end, when surface and faces are written. A level
// that proves hard while the run is on its way is factored (v_cycle.h); that comes on top:
// MemoryLedger::fits() keeps to the limit then.
std::int64_t peak_bytes(const Counts& c, int levels, Energy energy, bool tense, bool back_leg) {
  const std::int64_t n = std::int64_t(1) << levels;
  const std::int64_t points = c.points(levels), below = levels > 0 ? c.points(levels - 1) : 0;
  std::int64_t all_points = 0, solved_points = 0;
  int factored = c.base(levels);
  for (int l = 0; l <= levels; ++l) {
    all_points += c.points(l);
    if (l >= c.base(levels)) solved_points += c.points(l);
    if (c.unknowns(l) <= std::int64_t(tiny_level)) factored = std::max(factored, l);
  }
  // The coarsest is, however large, where vertices are unknowns.
  const std::int64_t coarsest = c.unknowns(factored);
  const bool direct = c.free_vertices > 0 || coarsest <= std::int64_t(direct_limit);
  // Beside it what is assembled, where that is no tiny level's.
  const std::int64_t assembled =
      mixed(c, 280, 360) * std::max<std::int64_t>(coarsest - std::int64_t(tiny_level), 0);
  const std::int64_t factor = direct ? plate_factor_bytes(c, factored) + assembled : 0;
  // The surface, the vectors of conjugate gradients, one of loads on pads, and one more to measure
  // or diagonalize; and what a start needs of the level below.
  const std::int64_t outer = 6 * vector_bytes * points + 3 * vector_bytes * below;
  // The V-cycle's vectors in single precision, and the diagonal.
  const std::int64_t cycle = solved_points * (4 * float_vector_bytes + 4);
  // The first smoothed levels estimate their spectrum with five vectors more.
  const std::int64_t estimated = c.points(std::min(levels, tense ? 4 : 2));
  const std::int64_t spectrum =
      estimated > std::int64_t(tiny_level) ? 5 * float_vector_bytes * estimated : 0;
  // Of accumulation (grid/accumulate.h): rows along sides, slots of edges and of sides.
  const std::int64_t slots =
      float_vector_bytes * (3 * c.sides() * (2 * n + 1) + 6 * c.edges + 6 * c.sides());
  // Stencils: of control vertices over their rings, then of edges and of faces.
  const std::int64_t rings = 2 * c.sides() * (5 * 4 + 5 * 4 + 3 * 8 + 3 * 8 + 3 * 4) / 2;
  const std::int64_t stencils =
      rings + c.edges * (64 * 4 + 24 * (8 + 8 + 4)) + c.faces() * (12 * 8 + 16 * (8 + 4));
  const std::int64_t membrane = tense ? 8 * (2 * c.sides() + 8 * c.edges + 4 * c.faces()) : 0;
  const std::int64_t steps =
      energy == Energy::thin_plate ? 0 : step_bytes(c, levels, all_points, energy, tense);
  // Rings, the places of points in them, and what a sweep changes.
  const std::int64_t sweeps = back_leg ? 260 * points : 0;
  // Three or four ids a face, and its polygon.
  const std::int64_t output =
      n * n * (4 * index_bytes * c.welded_triangles() + 5 * index_bytes * c.welded_quads());
  // While the rows of level 1 are summed up: bytes a point, measured; corners that are fixed are a
  // quarter of them. Of no other level is it the peak.
  const std::int64_t summed = std::min(c.used_points(1), 4 * c.unknowns(1) / 3);
  const std::int64_t assembling =
      levels > 0 && has_rows(2, std::size_t(c.points(1)))
          ? stencils + membrane + mixed(c, 1800, 1910) * summed + (c.free_vertices > 0 ? factor : 0)
          : 0;
  // What does not grow with the mesh.
  constexpr std::int64_t fixed = 1 << 13;
  return std::max({outer + cycle + spectrum + slots + stencils + membrane + factor +
                       matrix_bytes(c, levels) + steps + sweeps,
                   assembling, vector_bytes * points + output}) +
         fixed;
}

RunSize run_size(const Counts& c, int levels, std::size_t shapes, Energy energy, bool tense,
                 bool back_leg = false) {
  RunSize size;
  const std::int64_t n = std::int64_t(1) << levels;
  size.points = c.welded_points(levels);
  size.solved = c.points(levels);
  size.triangles = n * n * (c.welded_triangles() + 2 * c.welded_quads());
  // More than that no sum here comes to; it tells what would not fit into its type.
  constexpr double most_of_point = 1 << 14;
  constexpr std::int64_t most = std::numeric_limits<std::int64_t>::max();
  size.bytes = most;
  if (double(size.solved) * (most_of_point + double(shapes) * double(vector_bytes)) < double(most))
    // Of a shape only its surface stays; it is solved in the same arrays.
    size.bytes = peak_bytes(c, levels, energy, tense, back_leg) +
                 std::int64_t(shapes) * vector_bytes * size.solved;
  return size;
}

}  // namespace

RunSize predict_size(std::int64_t vertices, std::span<const std::int64_t> corners,
                     std::span<const std::int64_t> offsets, int levels, std::size_t shapes,
                     Energy energy, bool tense) {
  return run_size(count_elements(vertices, corners, offsets), levels, shapes, energy, tense);
}

RunSize predict_size(const ControlMesh& mesh, const Unknowns& unknowns, int levels,
                     std::size_t shapes, Energy energy, bool tense, bool back_leg) {
  return run_size(count_elements(mesh, unknowns), levels, shapes, energy, tense, back_leg);
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

void require_fit(const PolygonMesh& mesh, const FairOptions& options) {
  // Every edge shared, and no vertex more than there are: no run is smaller.
  const auto corners = std::int64_t(mesh.corners.size());
  const std::size_t shapes = options.shape_count(mesh.coordinates.size());
  const Counts fewest{
      .vertices = mesh.vertex_count(), .edges = corners / 2, .triangles = corners / 4};
  const RunSize least =
      run_size(fewest, options.levels, shapes, options.energy, options.tension > 0);
  const std::size_t limit = options.bytes_allowed();
  if (limit && least.bytes > std::int64_t(limit))
    require_fit(predict_size(mesh.vertex_count(), mesh.corners, mesh.offsets, options.levels,
                             shapes, options.energy, options.tension > 0),
                options);
}

}  // namespace fairing
