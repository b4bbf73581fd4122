// SPDX-License-Identifier: GPL-3.0-or-later
#include "fair/memory_plan.h"

#include <algorithm>
#include <bit>
#include <cstdio>
#include <limits>
#include <string>

#include "check/error.h"
#include "energy/sparse_square.h"
#include "execution/memory.h"
#include "lattice/lattice.h"
#include "rows/limits.h"
#include "solver/coarse.h"

namespace fairing {
namespace {

struct Counts {
  std::int64_t vertices = 0, edges = 0, triangles = 0, quads = 0;
  std::int64_t sides() const { return 3 * triangles + 4 * quads; }
};

// A sparse Cholesky factor of so many unknowns of a plate, as minimum degree leaves it.
std::int64_t factor_bytes(std::int64_t unknowns) {
  return 12 * unknowns * (40 + 4 * std::bit_width(std::uint64_t(unknowns)));
}

// The thin plate's rows of levels with small faces, and those of the transfers between them.
std::int64_t row_bytes(const Counts& c, int levels) {
  const std::int64_t row = c.quads > 0 ? 250 : 190, transfer = 190;  // a point
  std::int64_t bytes = 0;
  for (int l = 1; l <= levels; ++l) {
    const std::int64_t size = lattice_size(c.vertices, c.edges, c.triangles, c.quads, l);
    if (has_rows(1 << l, std::size_t(size))) bytes += (row + transfer) * size;
  }
  return bytes;
}

// What Gauss-Newton steps hold beside the thin plate's system: rows of all levels, and the factor of the finest one that may
// prove hard; on the finest level surfaces, steps, and what steps are accelerated by.
std::int64_t step_bytes(const Counts& c, int levels, std::int64_t all_levels, Energy energy) {
  constexpr std::int64_t row = 112, moments = 112, surfaces = 560, square = 640;  // a point
  const bool varies = energy == Energy::minimum_variation;
  std::int64_t hard = 0, squares = 0;
  for (int l = 0; l <= levels; ++l) {
    const std::int64_t size = lattice_size(c.vertices, c.edges, c.triangles, c.quads, l);
    if (size <= std::int64_t(direct_limit_of_steps)) hard = size;
    if (1 << l <= most_points_of_square) squares += square * size;
  }
  const std::int64_t points = lattice_size(c.vertices, c.edges, c.triangles, c.quads, levels);
  return (varies ? 2 * row + moments : row) * all_levels + surfaces * points + squares +
         (varies ? 5 : 2) * factor_bytes(hard);
}

// What the driver, the solver and the passes hold at their peak. The factor of a level that proves hard on the way
// (solver/coarse.h) comes on top.
std::int64_t peak_bytes(const Counts& c, int levels, Energy energy) {
  const std::int64_t n = std::int64_t(1) << levels, faces = c.triangles + c.quads;
  const auto size = [&](int level) { return lattice_size(c.vertices, c.edges, c.triangles, c.quads, level); };
  const std::int64_t points = size(levels), below = levels > 0 ? size(levels - 1) : 0;
  constexpr std::int64_t tiny = 1600;  // as in surface.cpp, with the points that are no unknowns
  std::int64_t all_levels = 0, factored = 0;
  for (int l = 0; l <= levels; ++l) {
    all_levels += size(l);
    if (size(l) <= tiny) factored = size(l);
  }
  if (levels > 0) factored = std::max(factored, std::min<std::int64_t>(size(1), direct_limit));
  const std::int64_t outer =
      5 * 24 * points +
      (24 + 48) * below;  // x, the iteration's vectors, and one more to measure or diagonalize
  const std::int64_t inner = all_levels * (4 * 12 + 4);  // the cycle in float, and the diagonal
  // The first smoothed levels estimate their spectrum with five vectors more; two or three levels at the most are so.
  const std::int64_t spectrum = n <= 16 && points > tiny ? 5 * 12 * points : 0;
  const std::int64_t exchange = 12 * (3 * c.sides() * (2 * n + 1) + 6 * c.edges + 6 * c.sides());
  const std::int64_t rings = 2 * c.sides() * (5 * 4 + 5 * 4 + 3 * 8 + 3 * 8 + 3 * 4) / 2;
  const std::int64_t stencils =
      rings + c.edges * (64 * 4 + 24 * (8 + 8 + 4)) + faces * (12 * 8 + 16 * (8 + 4));
  const std::int64_t steps = energy == Energy::thin_plate ? 0 : step_bytes(c, levels, all_levels, energy);
  const std::int64_t output = n * n * (16 * c.triangles + 20 * c.quads);
  return std::max(outer + inner + spectrum + exchange + stencils + factor_bytes(factored) +
                      row_bytes(c, levels) + steps,
                  24 * points + output) +
         (1 << 14);
}

std::size_t memory_limit(const FairOptions& options) {
  return options.memory_limit ? options.memory_limit : physical_memory() / 4 * 3;
}

RunSize run_size(const Counts& c, int levels, std::size_t shapes, Energy energy) {
  RunSize size;
  const std::int64_t n = std::int64_t(1) << levels;
  size.points = lattice_size(c.vertices, c.edges, c.triangles, c.quads, levels);
  size.triangles = n * n * (c.triangles + 2 * c.quads);
  // A shape takes what comes out of it; it is solved where the first surface was.
  size.bytes = peak_bytes(c, levels, energy) + std::int64_t(shapes) * 24 * size.points;
  return size;
}

}  // namespace

RunSize predict_size(const PolygonMesh& mesh, int levels, std::size_t shapes, Energy energy) {
  Counts c;
  c.vertices = mesh.vertex_count();
  std::vector<std::uint64_t> keys;
  keys.reserve(mesh.corners.size());
  for (std::int64_t f = 0; f < mesh.face_count(); ++f) {
    const auto face = mesh.face(f);
    const auto size = std::int64_t(face.size());
    for (std::size_t k = 0; k < face.size(); ++k) {
      const auto [low, high] = std::minmax(face[k], face[(k + 1) % face.size()]);
      keys.push_back(std::uint64_t(low) << 32 | std::uint64_t(high & 0xffffffff));
    }
    if (size <= 3) {
      ++c.triangles;
    } else if (size == 4) {
      ++c.quads;
    } else {
      c.triangles += size;
      c.edges += size;
      ++c.vertices;
    }
  }
  std::sort(keys.begin(), keys.end());
  c.edges += std::unique(keys.begin(), keys.end()) - keys.begin();
  return run_size(c, levels, shapes, energy);
}

RunSize predict_size(const ControlMesh& mesh, int levels, std::size_t shapes, Energy energy) {
  Counts c;
  c.vertices = mesh.vertex_count();
  c.edges = std::int64_t(mesh.edges.size());
  for (const Face& face : mesh.faces) ++(face.quad() ? c.quads : c.triangles);
  return run_size(c, levels, shapes, energy);
}

void require_fit(const RunSize& size, const FairOptions& options) {
  const std::size_t limit = memory_limit(options);
  const auto gigabytes = [](double bytes) {
    char text[32];
    std::snprintf(text, sizeof text, "%.3g GB", bytes / 1e9);
    return std::string(text);
  };
  if (limit && size.bytes > std::int64_t(limit))
    throw FairingError(ErrorCode::too_large, "This takes about " + gigabytes(double(size.bytes)) + " for " +
                                                 std::to_string(size.triangles) +
                                                 " triangles, over the limit of " + gigabytes(double(limit)) +
                                                 ". Use fewer levels, or raise memory_limit.");
  constexpr std::int64_t most = std::numeric_limits<std::int32_t>::max();
  if (3 * size.points > most || 3 * size.triangles > most)
    throw FairingError(
        ErrorCode::too_large,
        std::to_string(size.triangles) + " triangles are more than 32-bit ids can name. Use fewer levels.");
}

void require_fit(const PolygonMesh& mesh, const FairOptions& options) {
  // Every edge shared, and no vertex more than there are: no run is smaller.
  const auto corners = std::int64_t(mesh.corners.size());
  const std::size_t shapes = options.shape_count(mesh.coordinates.size());
  const RunSize least =
      run_size({mesh.vertex_count(), corners / 2, corners / 4, 0}, options.levels, shapes, options.energy);
  const std::size_t limit = memory_limit(options);
  if (limit && least.bytes > std::int64_t(limit))
    require_fit(predict_size(mesh, options.levels, shapes, options.energy), options);
}

}  // namespace fairing
