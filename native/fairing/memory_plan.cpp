// SPDX-License-Identifier: GPL-3.0-or-later
#include "fairing/memory_plan.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <string>

#include "base/error.h"
#include "curvature/normal_matrix.h"
#include "grid/grid_level.h"
#include "mesh/double_cover.h"
#include "mesh/half_edges.h"
#include "mesh/sheets.h"
#include "mesh/validate/check.h"
#include "multigrid/hierarchy.h"
#include "sparse/matrix.h"

namespace fairing {
namespace {

// Bytes of a vector in space, in double and in single precision, and of an index.
constexpr std::int64_t vector_bytes = 24, float_vector_bytes = 12, index_bytes = 4;

// Of control faces that are all triangles and quads.
struct Counts {
  std::int64_t vertices = 0, edges = 0, triangles = 0, quads = 0;
  // Of these, where sheets meet or have only one side.
  std::int64_t copied_vertices = 0, copied_edges = 0, copied_triangles = 0, copied_quads = 0;
  bool thin = false;  // so many thin faces that the smoother will take blocks
  bool even = false;  // hardly any face that is not about as long as wide
  std::int64_t welded_triangles() const { return triangles - copied_triangles; }
  std::int64_t welded_quads() const { return quads - copied_quads; }
  std::int64_t sides() const { return 3 * triangles + 4 * quads; }
  // Points of the surface after so many refinements.
  std::int64_t points(int level) const {
    return grid_size(vertices, edges, triangles, quads, level);
  }
  std::int64_t welded_points(int level) const {
    return grid_size(vertices - copied_vertices, edges - copied_edges, welded_triangles(),
                     welded_quads(), level);
  }
};

// Between what triangles and what quads take, by the points inside them.
std::int64_t mixed(const Counts& c, double triangle, double quad) {
  const double quads = double(c.quads), all = quads + 0.5 * double(c.triangles);
  return std::int64_t(triangle + (all > 0 ? quads / all : 0) * (quad - triangle)) + 1;
}

// Bytes a point of the smoother's blocks, where faces are thin (multigrid/block_jacobi.h).
std::int64_t block_bytes(const Counts& c) { return c.thin ? mixed(c, 190, 110) : 0; }

// The assembled matrices of the thin plate, on levels with small faces, and those of the transfers
// between them. Bytes a point, measured: equal rows along edges and inside faces share their numbers,
// so that they fall with the pieces of an edge.
std::int64_t matrix_bytes(const Counts& c, int levels) {
  constexpr double row[2][4] = {{90, 140, 102, 72}, {120, 162, 124, 90}},
                   transfer[2][4] = {{90, 98, 108, 66}, {110, 127, 120, 70}};
  const std::int64_t blocks = block_bytes(c);
  std::int64_t bytes = 0;
  for (int l = 1; l <= std::min(levels, 4); ++l)
    if (has_rows(1 << l, std::size_t(c.points(l))))
      bytes += (mixed(c, row[0][l - 1] + transfer[0][l - 1], row[1][l - 1] + transfer[1][l - 1]) +
                blocks) *
               c.points(l);
  return bytes;
}

// Numbers a column of the factor of minimum variation, whose rows reach farther than a plate's.
// Measured on 1,700 to 29,000 unknowns: 137 to 295 of triangles, 230 to 340 of quads, about 15 %
// less where faces have few points.
double columns_of_variation(const Counts& c, int level, std::int64_t unknowns) {
  const double doublings = std::log2(double(std::max<std::int64_t>(unknowns, 2)));
  const auto entries = double(mixed(c, 39 * doublings - 283, 52 * doublings - 425));
  return std::max(30.0, level > 2 ? entries : 0.85 * entries);
}

// What the level takes that steps to minimum variation prove hard, beside what they hold there of
// the finest: its factor, and what assembling it takes beside the last one. Faces of all shapes make
// a level hard, other than even ones.
std::int64_t hard_bytes(const Counts& c, int levels, std::int64_t on_finest) {
  int hard = -1;
  for (int l = 0; l <= levels && !c.even; ++l)
    if (c.points(l) - c.vertices <= std::int64_t(direct_limit_of_hard)) hard = l;
  if (hard < 0) return on_finest;
  const std::int64_t points = c.points(hard);
  const double factor = double(matrix_entry) * columns_of_variation(c, hard, points);
  return std::int64_t(factor * double(points)) + std::max(on_finest, mixed(c, 1450, 1930) * points);
}

// What Gauss-Newton steps hold beside the thin plate's systems. Bytes a point: on all levels the
// rows of the Jacobian, and for minimum variation as many again and moments; on levels with few
// points an edge the normal matrix; on the finest level surfaces, steps, and what steps are
// accelerated with.
std::int64_t step_bytes(const Counts& c, int levels, std::int64_t all_points, std::int64_t factor,
                        Energy energy, bool tense) {
  constexpr std::int64_t moments = 112, surfaces = 480;
  const std::int64_t row = mixed(c, 84, 108), normal_matrix = mixed(c, 482, 620);
  const bool varies = energy == Energy::minimum_variation;
  std::int64_t normal_matrices = 0;
  for (int l = 0; l <= levels; ++l)
    if (1 << l <= most_pieces_of_matrix) normal_matrices += normal_matrix * c.points(l);
  const std::int64_t rows = (varies ? 2 * row + moments : row + block_bytes(c)) +
                            (tense ? row / 3 : 0),
                     on_finest = surfaces * c.points(levels), usual = on_finest + factor;
  return rows * all_points + normal_matrices +
         (varies ? std::max(hard_bytes(c, levels, on_finest), usual) : usual);
}

// The peak of a run: while it solves, or at its end, when surface and faces are written. A level
// that proves hard while the run is on its way gets blocks (multigrid/block_jacobi.h), or is factored
// (v_cycle.h); that comes on top: MemoryLedger::fits() keeps to the limit then.
std::int64_t peak_bytes(const Counts& c, int levels, Energy energy, bool tense, bool back_leg,
                        bool moves) {
  const std::int64_t n = std::int64_t(1) << levels, faces = c.triangles + c.quads;
  const std::int64_t points = c.points(levels), below = levels > 0 ? c.points(levels - 1) : 0;
  // Unknowns of a level that is solved directly, and a third more for the points that are none.
  constexpr std::int64_t tiny = tiny_level + tiny_level / 3;
  std::int64_t all_points = 0, factored = 0;
  for (int l = 0; l <= levels; ++l) {
    all_points += c.points(l);
    if (c.points(l) <= tiny) factored = c.points(l);
  }
  if (levels > 0 && c.points(1) - c.vertices <= std::int64_t(direct_limit))
    factored = std::max(factored, c.points(1));
  if (moves) factored = std::max(factored, c.points(0));
  // Beside it what is assembled, where that is no tiny level's.
  const std::int64_t assembled = mixed(c, 280, 360) * std::max<std::int64_t>(factored - tiny, 0);
  const auto factor = std::int64_t(factor_bytes(std::size_t(factored))) + assembled;
  // The surface, the vectors of conjugate gradients, one of loads on pads, and one more to measure
  // or diagonalize; and what a start needs of the level below.
  const std::int64_t outer = 6 * vector_bytes * points + 3 * vector_bytes * below;
  // The V-cycle's vectors in single precision, and the diagonal.
  const std::int64_t cycle = all_points * (4 * float_vector_bytes + 4);
  // The first smoothed levels estimate their spectrum with five vectors more.
  const std::int64_t estimated = c.points(std::min(levels, tense ? 4 : 2));
  const std::int64_t spectrum = estimated > tiny ? 5 * float_vector_bytes * estimated : 0;
  // Of accumulation (grid/accumulate.h): rows along sides, slots of edges and of sides.
  const std::int64_t slots =
      float_vector_bytes * (3 * c.sides() * (2 * n + 1) + 6 * c.edges + 6 * c.sides());
  // Stencils: of control vertices over their rings, then of edges and of faces.
  const std::int64_t rings = 2 * c.sides() * (5 * 4 + 5 * 4 + 3 * 8 + 3 * 8 + 3 * 4) / 2;
  const std::int64_t stencils =
      rings + c.edges * (64 * 4 + 24 * (8 + 8 + 4)) + faces * (12 * 8 + 16 * (8 + 4));
  const std::int64_t membrane = tense ? 8 * (2 * c.sides() + 8 * c.edges + 4 * faces) : 0;
  const std::int64_t steps =
      energy == Energy::thin_plate ? 0 : step_bytes(c, levels, all_points, factor, energy, tense);
  // Rings, the places of points in them, and what a sweep changes.
  const std::int64_t sweeps = back_leg ? 260 * points : 0;
  // Three or four ids a face, and its polygon.
  const std::int64_t output =
      n * n * (4 * index_bytes * c.welded_triangles() + 5 * index_bytes * c.welded_quads());
  // While the rows of level 1 are summed up: bytes a point, measured. Of no other level is it the peak.
  const std::int64_t assembling =
      levels > 0 && has_rows(2, std::size_t(c.points(1)))
          ? stencils + membrane + mixed(c, 1800, 1910) * c.points(1) + (moves ? factor : 0)
          : 0;
  // What does not grow with the mesh.
  constexpr std::int64_t fixed = 1 << 15;
  return std::max({outer + cycle + spectrum + slots + stencils + membrane + factor +
                       matrix_bytes(c, levels) + steps + sweeps,
                   assembling, vector_bytes * points + output}) +
         fixed;
}

RunSize run_size(const Counts& c, int levels, std::size_t shapes, Energy energy, bool tense,
                 bool back_leg = false, bool moves = false) {
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
    size.bytes = peak_bytes(c, levels, energy, tense, back_leg, moves) +
                 std::int64_t(shapes) * vector_bytes * size.solved;
  return size;
}

// Thin: more than a twentieth of the faces are longer than eight times their area by length, as quads
// of 1 to 8 are. Even: at most a tenth are longer than that of an equilateral triangle 1.7 times, or
// of a square twice.
void judge_shapes(const ControlMesh& mesh, Counts& c) {
  std::size_t thin = 0, uneven = 0;
  for (const Face& face : mesh.faces) {
    const auto corner = [&](std::size_t i) { return mesh.positions[std::size_t(face.vertex[i])]; };
    const std::size_t size = face.quad() ? 4 : 3;
    double longest = 0, twice_area = 0;
    for (std::size_t i = 0; i < size; ++i)
      longest = std::max(longest, (corner((i + 1) % size) - corner(i)).squaredNorm());
    for (std::size_t i = 2; i < size; ++i)
      twice_area += (corner(i - 1) - corner(0)).cross(corner(i) - corner(0)).norm();
    thin += longest > 4 * twice_area;
    uneven += longest > (face.quad() ? 1 : 2) * twice_area;
  }
  c.thin = 20 * thin > mesh.faces.size();
  c.even = 10 * uneven <= mesh.faces.size();
}

// Faces with the vertices that they have, numbered in order. Their places are nobody's concern.
OwnedPolygonMesh with_its_own_vertices(std::span<const std::int64_t> corners,
                                       std::span<const std::int64_t> offsets) {
  std::vector<std::int64_t> used(corners.begin(), corners.end());
  std::sort(used.begin(), used.end());
  used.erase(std::unique(used.begin(), used.end()), used.end());
  OwnedPolygonMesh mesh{std::vector<double>(3 * used.size()), {}, {offsets.begin(), offsets.end()}};
  mesh.corners.reserve(corners.size());
  for (const std::int64_t v : corners)
    mesh.corners.push_back(std::lower_bound(used.begin(), used.end(), v) - used.begin());
  return mesh;
}

// With polygons split around their centres, and one-sided sheets twice (mesh/double_cover.h).
void count_faces(const PolygonMesh& mesh, const DoubleCover& cover, Counts& c) {
  for (std::int64_t f = 0; f < mesh.face_count(); ++f) {
    const auto size = std::int64_t(mesh.face(f).size());
    const std::int64_t times = cover.has(std::int32_t(f)) ? 2 : 1;
    (size == 4 ? c.quads : c.triangles) += times * (size > 4 ? size : 1);
    if (size == 4) c.copied_quads += times - 1;
    if (size != 4) c.copied_triangles += (times - 1) * (size > 4 ? size : 1);
    if (size <= 4) continue;
    c.edges += times * size;
    c.copied_edges += (times - 1) * size;
    c.vertices += times;
    c.copied_vertices += times - 1;
  }
}

// Those between corners. Where more than two faces meet, each has an edge of its own.
void count_edges(const HalfEdges& half_edges, const DoubleCover& cover, Counts& c) {
  for (std::int32_t k = 0; k < half_edges.count(); ++k) {
    if (half_edges.twin(k) > k) continue;
    const std::int64_t times = cover.has(half_edges.face(k)) ? 2 : 1;
    c.edges += times;
    c.copied_edges += times - 1;
  }
  c.copied_edges += half_edges.sides_at_nonmanifold_edges() -
                    std::int64_t(half_edges.nonmanifold_edges().size()) / 2;
}

}  // namespace

RunSize predict_size(std::int64_t vertices, std::span<const std::int64_t> corners,
                     std::span<const std::int64_t> offsets, int levels, std::size_t shapes,
                     Energy energy, bool tense) {
  const OwnedPolygonMesh renumbered = with_its_own_vertices(corners, offsets);
  const PolygonMesh mesh = renumbered.view();
  const HalfEdges half_edges(mesh);
  const DoubleCover cover = begin_double_cover(mesh, half_edges);
  Counts c;
  c.vertices = vertices;
  count_faces(mesh, cover, c);
  count_edges(half_edges, cover, c);
  for (std::int64_t f = 0; f < mesh.face_count(); ++f)  // refused, or mended before
    if (repeats_a_vertex(mesh.face(f))) return run_size(c, levels, shapes, energy, tense);
  const auto copies = std::int64_t(count_copies(mesh, half_edges, cover));
  c.vertices += copies;
  c.copied_vertices += copies;
  return run_size(c, levels, shapes, energy, tense);
}

RunSize predict_size(const ControlMesh& mesh, int levels, std::size_t shapes, Energy energy,
                     bool tense, bool back_leg, bool moves) {
  Counts c;
  c.vertices = mesh.vertex_count();
  c.edges = std::int64_t(mesh.edges.size());
  c.copied_vertices = std::int64_t(mesh.copied_vertex.size() + mesh.copied_centre.size());
  c.copied_edges = std::int64_t(mesh.copied_edge.size());
  for (const Face& face : mesh.faces) ++(face.quad() ? c.quads : c.triangles);
  for (const Index f : mesh.copied_face)
    ++(mesh.faces[std::size_t(f)].quad() ? c.copied_quads : c.copied_triangles);
  judge_shapes(mesh, c);
  return run_size(c, levels, shapes, energy, tense, back_leg, moves);
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
                       "This takes about " + gigabytes(double(size.bytes)) + " for " +
                           std::to_string(size.triangles) + " triangles, over the limit of " +
                           gigabytes(double(limit)) + ". Use fewer levels, or raise memory_limit.");
  constexpr std::int64_t most = std::numeric_limits<std::int32_t>::max();
  if (3 * size.solved > most || 3 * size.triangles > most)
    throw FairingError(ErrorCode::too_large,
                       std::to_string(size.triangles) +
                           " triangles are more than 32-bit ids can name. Use fewer levels.");
}

void require_fit(const PolygonMesh& mesh, const FairOptions& options) {
  // Every edge shared, and no vertex more than there are: no run is smaller.
  const auto corners = std::int64_t(mesh.corners.size());
  const std::size_t shapes = options.shape_count(mesh.coordinates.size());
  const RunSize least = run_size({mesh.vertex_count(), corners / 2, corners / 4, 0}, options.levels,
                                 shapes, options.energy, options.tension > 0);
  const std::size_t limit = options.bytes_allowed();
  if (limit && least.bytes > std::int64_t(limit))
    require_fit(predict_size(mesh.vertex_count(), mesh.corners, mesh.offsets, options.levels,
                             shapes, options.energy, options.tension > 0),
                options);
}

}  // namespace fairing
