// SPDX-License-Identifier: GPL-3.0-or-later
#include "curvature/start.h"

#include <algorithm>
#include <utility>

#include "base/points.h"
#include "base/roundoff.h"
#include "curvature/steps.h"
#include "grid/grid_level.h"
#include "grid/runs.h"
#include "parallel/reductions.h"
#include "parallel/workers.h"
#include "transfer/quadratic.h"

namespace fairing {
namespace {

using Point = Eigen::Map<const Vec3>;

Vec3 midpoint(const double* p, const double* p_normal, const double* q, const double* q_normal) {
  const Point a(p), b(q), m(p_normal), n(q_normal);
  const Vec3 along = b - a;
  return 0.5 * (a + b) - 0.125 * (along.dot(m) * m - along.dot(n) * n);
}

// fine <- coarse, with new points as the normals at the ends of their edge prescribe (a quad's
// centre: both diagonals): the midpoints of curved PN triangles [Vlachos, Peters, Boyd, Mitchell
// 2001]. It does not overshoot, and spacing is that of straight edges, so it is a safe start where
// local quadratics in the control metric would wrinkle. Exact to fourth order. With unit normals m,
// n at a and b, the midpoint is
//
//   (a + b)/2 - ((b - a) . m) m / 8 + ((b - a) . n) n / 8.
//
// 3 numbers a point; a zero normal has no bulge. Throws FairingError(cancelled).
void prolong_with_normals(const GridLevel& coarse, const GridLevel& fine, Workers& workers,
                          const double* x, const double* normal, double* y) {
  const ControlMesh& mesh = coarse.mesh();
  const int n = coarse.n();
  std::copy_n(x, 3 * std::size_t(mesh.vertex_count()), y);
  for_edge_parts(coarse, workers, [&](Index begin, Index end) {
    std::vector<double> run(lane_stride(n)), normals(lane_stride(n));
    for (Index e = begin; e < end; ++e) {
      gather_edge(coarse, x, e, run.data());
      gather_edge(coarse, normal, e, normals.data());
      double* to = y + 3 * std::size_t(fine.edge_base(e));
      for (int k = 1; k < 2 * n; ++k, to += 3) {
        const std::size_t at = 3 * std::size_t(k / 2);
        if (k % 2 == 0)
          copy_point(to, run.data() + at);
        else
          put_point(midpoint(&run[at], &normals[at], &run[at + 3], &normals[at + 3]), to);
      }
    }
  });
  for_face_parts(coarse, workers, [&](Index begin, Index end) {
    std::vector<double> points(3 * closed_size(true, std::size_t(n))), normals(points.size());
    for (Index f = begin; f < end; ++f) {
      const bool quad = mesh.faces[f].quad();
      gather_face(coarse, x, f, points.data());
      gather_face(coarse, normal, f, normals.data());
      const auto between = [&](int i, int j, int k, int l) {
        const auto at = [&](int a, int b) {
          return 3 * (closed_row(quad, std::size_t(n), std::size_t(b)) + std::size_t(a));
        };
        return midpoint(&points[at(i, j)], &normals[at(i, j)], &points[at(k, l)],
                        &normals[at(k, l)]);
      };
      double* to = y + 3 * std::size_t(fine.face_base(f));
      for (int j = 1; j < 2 * n; ++j)
        for (int i = 1; i < (quad ? 2 * n : 2 * n - j); ++i, to += 3) {
          const int a = i / 2, b = j / 2, odd_i = i % 2, odd_j = j % 2;
          if (!odd_i || !odd_j)
            put_point(between(a, b, a + odd_i, b + odd_j),
                      to);  // of a point with itself: the point
          else if (quad)
            put_point(0.5 * (between(a, b, a + 1, b + 1) + between(a + 1, b, a, b + 1)), to);
          else
            put_point(between(a + 1, b, a, b + 1), to);
        }
    }
  });
}

// If the energy is this many times that of the level below, the polyhedron is tried (measured:
// tried always, a mirror ends at 2.5 times the energy; never, a bishop at 1.3 times).
constexpr double polyhedron_above = 10;

// The surface of `candidate`, from the number of a coordinate, at the unknowns, and of the plate
// elsewhere becomes iterate.current if it has less energy.
template <class Candidate>
void try_candidate(SurfaceIterate& it, const Array<double>& plate, CurvatureLevelReport& report,
                   Candidate&& candidate) {
  // zero, on every surface, for points that are not unknowns
  const Array<float>& diagonal = it.op().diagonal();
  Array<double>& trial = it.trial.points;
  for_each_index(it.workers(), plate.size(),
                 [&](std::size_t i) { trial[i] = diagonal[i / 3] > 0 ? candidate(i) : plate[i]; });
  it.system.symmetrize(it.level, trial);
  it.trial.functional = it.current.functional;
  it.system.linearize(it.level, it.trial);
  const double objective = it.op().objective();
  if (!(objective < (1 - roundoff) * report.start_energy)) return;
  report.start_energy = objective;
  std::swap(it.current, it.trial);
}

}  // namespace

void choose_start(SurfaceIterate& iterate, int level, const Pads* pads, const Array<double>& plate,
                  const Array<double>& plate_below, Reference reference,
                  std::span<const Vec3> given, CurvatureLevelReport& report) {
  const LinearizedSurface below = std::exchange(iterate.current, {});
  iterate.level = level;
  iterate.current.points = plate;
  iterate.system.symmetrize(level, iterate.current.points);
  iterate.linearize({CurvatureEnergy::total_curvature, pads});
  iterate.system.penalize(level, std::move(reference), iterate.current);
  report.plate_energy = report.start_energy = iterate.op().objective();
  // Rounding errors would decide between flat surfaces.
  if (report.start_energy < flat_energy) return;
  const GridLevel& grid = iterate.grid();
  Array<double>& trial = iterate.trial.points;
  trial.resize(plate.size());
  if (below.points.empty()) {
    if (given.size() == grid.size())
      try_candidate(iterate, plate, report, [&](std::size_t i) { return given[i / 3][i % 3]; });
    return;
  }
  const GridLevel& coarse = iterate.system.grid(level - 1);
  {
    Array<double> change(below.points.size());
    for_each_index(iterate.workers(), change.size(),
                   [&](std::size_t i) { change[i] = below.points[i] - plate_below[i]; });
    ElementSlots<double, 3> slots;
    prolong(coarse, grid, iterate.system.stencils(), nullptr, iterate.workers(), slots,
            change.data(), trial.data());
  }
  try_candidate(iterate, plate, report, [&](std::size_t i) { return plate[i] + trial[i]; });
  // Zero normals give the polyhedron.
  const auto try_refined = [&](const Array<double>& normal) {
    prolong_with_normals(coarse, grid, iterate.workers(), below.points.data(), normal.data(),
                         trial.data());
    try_candidate(iterate, plate, report, [&](std::size_t i) { return trial[i]; });
  };
  if (report.start_energy > incomparable_energy * below.energy)
    try_refined(below.linearization.normal);
  if (report.start_energy > polyhedron_above * below.energy)
    try_refined(Array<double>(below.points.size(), 0.0));
  iterate.current.held = below.held;  // densities, which hardly change between levels
}

}  // namespace fairing
