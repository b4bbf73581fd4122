// SPDX-License-Identifier: GPL-3.0-or-later
#include "fairing/extremes.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "base/error.h"
#include "base/median.h"
#include "parallel/reductions.h"

namespace fairing {
namespace {

// In sizes of the basis mesh, or in the usual distance from the centre: with the requested accuracy
// relative to the farthest vertex, the others keep six digits.
constexpr double far_out = 1e3;

// The input vertices on faces that are farther away than `distance`, in working coordinates.
std::vector<std::int64_t> vertices_outside(double distance, const ControlMesh& mesh,
                                           const ControlPositions& control) {
  std::vector<std::int64_t> out;
  for (Index v = 0; v < mesh.input_vertices; ++v)
    if (!mesh.ring(v).empty() && !(control.working[v].cwiseAbs().maxCoeff() < distance))
      out.push_back(v);
  return out;
}

std::vector<std::int64_t> vertices_far_away(const ControlMesh& mesh,
                                            const ControlPositions& control) {
  std::vector<Index> used;
  for (Index v = 0; v < mesh.input_vertices; ++v)
    if (!mesh.ring(v).empty()) used.push_back(v);
  Vec3 middle = Vec3::Zero();
  std::vector<double> values(used.size());
  for (Eigen::Index a = 0; a < 3; ++a) {
    for (std::size_t i = 0; i < used.size(); ++i) values[i] = control.working[used[i]][a];
    middle[a] = median(values);
  }
  for (std::size_t i = 0; i < used.size(); ++i)
    values[i] = (control.working[used[i]] - middle).stableNorm();
  const double usual = median(std::vector(values));
  std::vector<std::int64_t> out;
  for (std::size_t i = 0; i < used.size(); ++i)
    if (!(values[i] <= far_out * usual)) out.push_back(used[i]);
  return out;
}

}  // namespace

bool lies_far_out(const ControlMesh& mesh, const ControlPositions& control) {
  return !vertices_outside(far_out, mesh, control).empty();
}

void require_in_reach(const ControlMesh& mesh, const ControlPositions& control) {
  // in sizes of the basis mesh; single precision holds the squares too
  const double out_of_reach = 1 / std::numeric_limits<double>::epsilon();
  std::vector<std::int64_t> far = vertices_outside(out_of_reach, mesh, control);
  if (far.empty()) return;
  throw FairingError(
      ErrorCode::too_extreme,
      {"{vertex} {lies|lie} so far from the mesh that the rest would have no digits left.",
       "Move or delete them."},
      std::move(far));
}

void require_finite(const ControlMesh& mesh, const ControlPositions& control, Workers& workers,
                    std::size_t size, const double* x) {
  if (std::isfinite(largest(workers, size, [&](std::size_t i) { return x[i]; }))) return;
  std::vector<std::int64_t> far = vertices_far_away(mesh, control);
  if (far.empty())
    throw FairingError(
        ErrorCode::too_extreme,
        {"The surface cannot be computed: lengths or angles of the mesh are too far apart.",
         "Even out its thinnest faces, or use energy=\"thin_plate\"."});
  throw FairingError(
      ErrorCode::too_extreme,
      {"The surface cannot be computed: {vertex} {lies|lie} over a thousand times as "
       "far out as most.",
       "Move or delete them."},
      std::move(far));
}

}  // namespace fairing
