// SPDX-License-Identifier: GPL-3.0-or-later
#include "curvature/distance_penalty.h"

#include <cmath>
#include <utility>

#include "parallel/reductions.h"

namespace fairing {

// The thin plate's weight (thin_face_penalty) with the bending of the surface itself.
DistancePenalty::DistancePenalty(const GridLevel& grid, Reference reference,
                                 const Array<float>& shape, const Unknowns& unknowns)
    : reference_(std::move(reference)) {
  const std::vector<std::uint8_t> is_unknown = unknown_points(grid, unknowns);
  const double cells = double(grid.n()) * double(grid.n());
  weight_.resize(grid.size());
  area_.resize(grid.size());
  for (std::size_t p = 0; p < weight_.size(); ++p) {
    const float* m = &shape[4 * p];
    const double area = double(m[3]) * double(m[3]);
    const double square = double(m[0]) * m[0] + double(m[1]) * m[1] + double(m[2]) * m[2];
    area_[p] = float(area);
    weight_[p] = is_unknown[p] ? float(square * area * std::pow(cells * area, 2) *
                                       std::pow(double(reference_.thin[p]), 4))
                               : 0.0f;
  }
}

// Variation is curvature over a length, here the shortest control edge r; thin^4 has r^-6.
void DistancePenalty::set_energy(CurvatureEnergy energy) {
  if (std::exchange(energy_, energy) == energy) return;
  const double power = energy == CurvatureEnergy::minimum_variation ? 4.0 / 3 : -4.0 / 3;
  for (std::size_t p = 0; p < weight_.size(); ++p)
    if (weight_[p] > 0) weight_[p] *= float(std::pow(double(reference_.thin[p]), power));
  if (energy != CurvatureEnergy::minimum_variation) return;
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
