// SPDX-License-Identifier: GPL-3.0-or-later
#include "curvature/distance_penalty.h"

#include <cmath>
#include <utility>

#include "curvature/point_curvature.h"
#include "grid/limit_surface.h"
#include "parallel/reductions.h"

namespace fairing {
namespace {

// Own entry of a Laplacian at a point with this area.
double stiffness(double area) { return 4 / area; }

}  // namespace

// The thin plate's weight (LimitSurface::penalty) with the bending of the surface itself. Variation is
// curvature over a length, here the shortest control edge r; thin^4 has r^-6. On flats the factor is
// the Laplacian's again.
DistancePenalty::DistancePenalty(const GridLevel& grid, Reference reference,
                                 const Array<float>& shape, const Unknowns& unknowns, bool varies)
    : points_(std::move(reference.points)), weight_(grid.size(), 0.0f) {
  const std::vector<std::uint8_t> is_unknown = unknown_points(grid, unknowns);
  const double cells = double(grid.n()) * double(grid.n());
  if (varies) of_variation_ = in_cycles_ = weight_;
  for (std::size_t p = 0; p < weight_.size(); ++p) {
    if (!is_unknown[p]) continue;
    const double area = area_of(&shape[4 * p]), thin = reference.thin[p];
    const bool is_flat = std::isinf(thin);
    weight_[p] = is_flat ? float(flat_penalty * stiffness(area))
                         : float(square_of(&shape[4 * p]) * area * std::pow(cells * area, 2) *
                                 std::pow(thin, 4));
    if (!varies || !(weight_[p] > 0)) continue;
    of_variation_[p] =
        float(weight(p, false) * (is_flat ? stiffness(area) : std::pow(thin, 4.0 / 3)));
    in_cycles_[p] = float(std::cbrt(area * weight(p, true) * weight(p, true)));
  }
}

double DistancePenalty::energy(const double* x, bool varies, Workers& workers) const {
  return sum(workers, weight_.size(), [&](std::size_t p) {
    double square = 0;
    for (std::size_t a = 3 * p; a < 3 * p + 3; ++a)
      square += (x[a] - points_[a]) * (x[a] - points_[a]);
    return weight(p, varies) * square;
  });
}

void DistancePenalty::add_force(const double* x, const double* normal, bool varies,
                                Workers& workers, double* force) const {
  for_each_index(workers, weight_.size(), [&](std::size_t p) {
    for (std::size_t a = 3 * p; a < 3 * p + 3; ++a)
      force[p] -= weight(p, varies) * normal[a] * (x[a] - points_[a]);
  });
}

}  // namespace fairing
