// SPDX-License-Identifier: GPL-3.0-or-later
#include "curvature/distance_penalty.h"

#include <cmath>
#include <utility>

#include "grid/limit_surface.h"
#include "parallel/reductions.h"

namespace fairing {
namespace {

// Own entry of a Laplacian at a point with this area.
double stiffness(double area) { return 4 / area; }

}  // namespace

// The thin plate's weight (LimitSurface::penalty) with the bending of the surface itself.
DistancePenalty::DistancePenalty(const GridLevel& grid, Reference reference,
                                 const Array<float>& shape, const Unknowns& unknowns)
    : reference_(std::move(reference)) {
  const std::vector<std::uint8_t> is_unknown = unknown_points(grid, unknowns);
  const double cells = double(grid.n()) * double(grid.n());
  weight_.assign(grid.size(), 0.0f);
  area_.resize(grid.size());
  for (std::size_t p = 0; p < weight_.size(); ++p) {
    const float* m = &shape[4 * p];
    const double area = double(m[3]) * double(m[3]);
    const double square = double(m[0]) * m[0] + double(m[1]) * m[1] + double(m[2]) * m[2];
    area_[p] = float(area);
    if (!is_unknown[p]) continue;
    weight_[p] = is_flat(p) ? float(flat_penalty * stiffness(area))
                            : float(square * area * std::pow(cells * area, 2) *
                                    std::pow(double(reference_.thin[p]), 4));
  }
}

// Variation is curvature over a length, here the shortest control edge r; thin^4 has r^-6. On flats
// the factor is the Laplacian's again.
void DistancePenalty::set_energy(CurvatureEnergy energy) {
  if (std::exchange(energy_, energy) == energy) return;
  const bool varies = energy == CurvatureEnergy::minimum_variation;
  for (std::size_t p = 0; p < weight_.size(); ++p) {
    if (!(weight_[p] > 0)) continue;
    const double factor =
        is_flat(p) ? stiffness(area_[p]) : std::pow(double(reference_.thin[p]), 4.0 / 3);
    weight_[p] = float(varies ? weight(p) * factor : weight(p) / factor);
  }
  if (!varies) return;
  in_cycles_.resize(weight_.size());
  for (std::size_t p = 0; p < weight_.size(); ++p)
    in_cycles_[p] = float(std::cbrt(double(area_[p]) * weight(p) * weight(p)));
}

double DistancePenalty::energy(const double* x, Workers& workers) const {
  return sum(workers, weight_.size(), [&](std::size_t p) {
    double square = 0;
    for (std::size_t a = 3 * p; a < 3 * p + 3; ++a)
      square += (x[a] - reference_.points[a]) * (x[a] - reference_.points[a]);
    return weight(p) * square;
  });
}

void DistancePenalty::add_force(const double* x, const double* normal, Workers& workers,
                                double* force) const {
  for_each_index(workers, weight_.size(), [&](std::size_t p) {
    for (std::size_t a = 3 * p; a < 3 * p + 3; ++a)
      force[p] -= weight(p) * normal[a] * (x[a] - reference_.points[a]);
  });
}

}  // namespace fairing
