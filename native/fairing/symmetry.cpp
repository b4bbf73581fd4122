// SPDX-License-Identifier: GPL-3.0-or-later
#include "fairing/symmetry.h"

#include <limits>

#include "base/roundoff.h"

namespace fairing {
namespace {

// Largest distance of two positions in working coordinates that count as the same: rounding in the
// caller's computation at the mesh's size, and some units in the last place of world coordinates.
double same_place(const Frame& frame) {
  const double place = std::numeric_limits<double>::epsilon() * frame.centre.norm() / frame.scale;
  return roundoff + 8 * place;
}

// Corners and ends of chains need no test of their own, since they change the curves.
bool mirrors_curves(const ControlMesh& mesh, const Mirror& mirror, const FeatureCurves& curves,
                    double tolerance) {
  const auto count = std::size_t(curves.points_per_edge);
  for (std::size_t e = 0; e < mesh.edges.size(); ++e) {
    if (curves.run[e] < 0) continue;
    if (curves.run[std::size_t(mirror.edge[e])] < 0) return false;
    const auto points = curves.of(Index(e)), opposite = curves.of(mirror.edge[e]);
    const bool reversed = mirror.reverses(mesh, Index(e));
    for (std::size_t k = 0; k < count; ++k) {
      const Vec3& image = opposite[reversed ? count - 1 - k : k];
      if ((mirror.plane.image(points[k]) - image).norm() > tolerance) return false;
    }
  }
  return true;
}

bool mirrors_weights(const ControlMesh& mesh, const Mirror& mirror,
                     const std::vector<double>& weights) {
  for (std::size_t v = 0; v < weights.size(); ++v) {
    const Index image = mesh.original_vertex(mirror.vertex[v]);
    if (!mesh.ring(Index(v)).empty() && weights[v] != weights[std::size_t(image)]) return false;
  }
  return true;
}

}  // namespace

std::vector<Mirror> find_symmetry(const ControlMesh& mesh, const ControlPositions& control,
                                  const Frame& frame, const FairOptions& options) {
  const double tolerance = same_place(frame);
  return find_mirrors(mesh, tolerance, [&](const Mirror& mirror) {
    return mirrors_weights(mesh, mirror, options.weights) &&
           (options.tolerance.size() == 1 || mirrors_weights(mesh, mirror, options.tolerance)) &&
           mirrors_curves(mesh, mirror, control.working_curves, tolerance);
  });
}

Mirrors kept_by(const ControlPositions& control, const ControlMesh& mesh, const Frame& frame,
                const std::vector<Mirror>& mirrors) {
  const double tolerance = same_place(frame);
  Mirrors kept;
  for (const Mirror& mirror : mirrors)
    if (mirrors_positions(mesh, mirror, control.working, tolerance) &&
        mirrors_curves(mesh, mirror, control.working_curves, tolerance))
      kept.push_back(&mirror);
  return kept;
}

}  // namespace fairing
