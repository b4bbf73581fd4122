// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/pcg.h"

#include <cmath>

#include "execution/vectors.h"

namespace fairing {

PcgResult conjugate_gradients(VCycle& cycle, std::size_t top, Workers& workers, const PcgLimits& limits,
                              PcgState& s, double* x, const std::function<bool(const PcgResult&)>& each) {
  CycleLevel& level = cycle.levels[top];
  const std::size_t size = level.op->size();
  double *r = s.residual.data(), *p = s.direction.data(), *q = s.image.data();
  const float* z = level.state.x.data();

  PcgResult result;
  double size_of_residual = norm(workers, size, r), rz = 0, step = 0;
  const double residual_scale = limits.from_start ? size_of_residual : limits.residual_scale;
  double energy_scale = limits.from_start ? 0 : limits.energy_scale;
  const auto relative = [&](double length) { return residual_scale > 0 ? length / residual_scale : 0.0; };
  int degree = cycle.degree;
  result.residual = relative(size_of_residual);
  result.history.push_back(result.residual);
  if (size_of_residual <= limits.noise) {
    result.converged = true;
    return result;
  }
  for (;;) {
    // The preconditioner works on a residual of order one: single precision has no room for tiny units.
    const double unit = size_of_residual;
    for_each_index(workers, size, [&](std::size_t i) { level.state.residual[i] = float(r[i] / unit); });
    cycle.run(top);
    const double rz_new = unit * sum(workers, size, [&](std::size_t i) { return r[i] * double(z[i]); });
    const double error = std::sqrt(std::max(0.0, rz_new));
    if (limits.from_start && result.iterations == 0) energy_scale = error;
    result.energy_error = energy_scale > 0 ? error / energy_scale : 0.0;
    result.converged = (result.residual <= limits.tolerance || size_of_residual <= limits.noise) &&
                       (result.energy_error <= limits.tolerance || size_of_residual <= limits.noise);
    if (result.converged || result.iterations >= limits.max_iterations) return result;
    // A new preconditioner starts a new sequence of conjugate directions.
    const bool fresh = result.iterations == 0 || cycle.degree != degree;
    degree = cycle.degree;
    // Flexible beta: z.(r - r_old) / (z_old.r_old), and r - r_old is -step q.
    const double beta =
        fresh ? 0.0
              : -step * unit * sum(workers, size, [&](std::size_t i) { return double(z[i]) * q[i]; }) / rz;
    for_each_index(workers, size,
                   [&](std::size_t i) { p[i] = unit * double(z[i]) + (beta != 0 ? beta * p[i] : 0.0); });
    rz = rz_new;
    level.op->apply(p, q);
    const double pq = sum(workers, size, [&](std::size_t i) { return p[i] * q[i]; });
    if (!(pq > 0) || !std::isfinite(pq)) {
      result.stalled = true;
      return result;
    }
    step = sum(workers, size, [&](std::size_t i) { return p[i] * r[i]; }) / pq;
    for_each_index(workers, size, [&](std::size_t i) {
      x[i] += step * p[i];
      r[i] -= step * q[i];
    });
    size_of_residual = norm(workers, size, r);
    ++result.iterations;
    result.residual = relative(size_of_residual);
    result.history.push_back(result.residual);
    if (!each(result)) return result;
  }
}

}  // namespace fairing
