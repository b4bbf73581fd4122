// SPDX-License-Identifier: GPL-3.0-or-later
#include "fair/memory_plan.h"

#include <cstdio>
#include <limits>
#include <string>

#include "check/error.h"
#include "execution/memory.h"
#include "lattice/lattice.h"

namespace fairing {
namespace {

struct Counts {
  std::int64_t vertices = 0, edges = 0, triangles = 0, quads = 0;
  std::int64_t sides() const { return 3 * triangles + 4 * quads; }
};

// What the driver, the solver and the passes hold at their peak, in numbers of bytes.
std::int64_t peak_bytes(const Counts& c, int levels) {
  const std::int64_t n = std::int64_t(1) << levels;
  const std::int64_t points = lattice_size(c.vertices, c.edges, c.triangles, c.quads, levels);
  const std::int64_t below =
      levels > 0 ? lattice_size(c.vertices, c.edges, c.triangles, c.quads, levels - 1) : 0;
  const std::int64_t all_levels = points + below + below / 2;
  const std::int64_t outer = points * 4 * 24;            // conjugate gradients in double: x, r, p, q
  const std::int64_t inner = all_levels * (4 * 12 + 4);  // the cycle in float, and the diagonal
  const std::int64_t exchange = (8 + 4) * (3 * c.sides() * (2 * n + 1) + 6 * c.edges + 6 * c.sides());
  const std::int64_t rings = c.sides() * 2 * (40 + 2 * 36) / 2;
  const std::int64_t stencils =
      rings + c.edges * (256 + 192 * 2 + 96) + (c.triangles + c.quads) * (96 + 128 + 64);
  const std::int64_t output = n * n * (c.triangles + 2 * c.quads) * 12 + n * n * c.quads * 16;
  return outer + inner + exchange + stencils + output;
}

RunSize run_size(const Counts& c, int levels) {
  RunSize size;
  const std::int64_t n = std::int64_t(1) << levels;
  size.points = lattice_size(c.vertices, c.edges, c.triangles, c.quads, levels);
  size.triangles = n * n * (c.triangles + 2 * c.quads);
  size.bytes = peak_bytes(c, levels);
  return size;
}

}  // namespace

RunSize predict_size(const PolygonMesh& mesh, int levels) {
  Counts c;
  c.vertices = mesh.vertex_count();
  std::int64_t corners = 0;
  for (std::int64_t f = 0; f < mesh.face_count(); ++f) {
    const auto size = std::int64_t(mesh.face(f).size());
    corners += size;
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
  c.edges += corners;  // as many as if no edge were shared
  RunSize closed = run_size({c.vertices, c.edges - corners / 2, c.triangles, c.quads}, levels);
  return closed;
}

RunSize predict_size(const ControlMesh& mesh, int levels) {
  Counts c;
  c.vertices = mesh.vertex_count();
  c.edges = std::int64_t(mesh.edges.size());
  for (const Face& face : mesh.faces) ++(face.quad() ? c.quads : c.triangles);
  return run_size(c, levels);
}

void require_fit(const RunSize& size, const FairOptions& options) {
  const std::size_t limit = options.memory_limit ? options.memory_limit : physical_memory() / 4 * 3;
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

}  // namespace fairing
