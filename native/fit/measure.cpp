// SPDX-License-Identifier: GPL-3.0-or-later
#include "fit/measure.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "base/points.h"
#include "fit/held_out.h"
#include "parallel/cancel.h"
#include "parallel/reductions.h"

namespace fairing {
namespace {

// The finest level up to `most` whose cells have this many points on average; at least level 0.
int level_with(double points_a_cell, const Cells& cells, std::size_t points, int most) {
  int level = std::min(most, cells.grid().level());
  const auto faces = double(cells.grid().mesh().faces.size());
  while (level > 0 && double(points) < points_a_cell * faces * std::pow(4.0, level)) --level;
  return level;
}

// For each cell of a coarser level: the number of its points, and the sums of their offsets and
// squared offsets, each offset limited to `most`.
struct CellSums {
  std::vector<Index> count;
  std::vector<double> sum, squares;

  // Deviation from the mean of each cell: the noise without the error of the surface.
  double scatter() const {
    double left = 0, free = 0;
    for (std::size_t c = 0; c < count.size(); ++c) {
      if (count[c] < 2) continue;
      left += squares[c] - sum[c] * sum[c] / count[c];
      free += count[c] - 1;
    }
    return free > 0 ? std::sqrt(std::max(left, 0.0) / free) : 0;
  }
};

CellSums sums_on(const Cells& coarse, const Cells& cells, const Array<Foot>& feet, double most) {
  CellSums out{std::vector<Index>(coarse.size()), std::vector<double>(coarse.size()),
               std::vector<double>(coarse.size())};
  for (const std::size_t s : Cancellable(feet.size())) {
    if (!feet[s].is_used()) continue;
    const FacePlace place = cells.place(feet[s].cell, feet[s].shares);
    const auto cell = std::size_t(coarse.cell_at(place, cells.grid().level()).cell);
    ++out.count[cell];
    const double offset = std::clamp(double(feet[s].offset), -most, most);
    out.sum[cell] += offset;
    out.squares[cell] += offset * offset;
  }
  return out;
}

// Returns the scatter of the points about the mean of their cell, with offsets limited to `most`.
double measure_coverage(const Cells& cells, const Array<Foot>& feet, Workers& workers,
                        std::size_t polygons, double most, FitReport& report) {
  const ControlMesh& mesh = cells.grid().mesh();
  const GridLevel grid(mesh, level_with(points_a_blob, cells, feet.size(), 2));
  const Cells coarse(grid, workers);
  const CellSums sums = sums_on(coarse, cells, feet, most);
  std::vector<double> all(polygons), covered(polygons);
  for (std::size_t c = 0; c < coarse.size(); ++c) {
    const auto polygon = std::size_t(mesh.faces[coarse.face(Index(c))].polygon);
    all[polygon] += 1;
    covered[polygon] += sums.count[c] > 0;
  }
  report.coverage.resize(polygons);
  for (std::size_t f = 0; f < polygons; ++f)
    report.coverage[f] = all[f] > 0 ? covered[f] / all[f] : 0;
  return sums.scatter();
}

// Faces with offsets of one sign over a quarter of the face: larger than the noise, and larger than
// a mean of noise can be by chance.
void find_too_coarse(const Cells& cells, const Array<Foot>& feet, Workers& workers, double noise,
                     double most, FitReport& report) {
  constexpr double by_chance = 4;  // standard deviations of a mean of noise: one cell in 16,000
  const ControlMesh& mesh = cells.grid().mesh();
  const GridLevel grid(mesh, std::min(1, cells.grid().level()));
  const Cells coarse(grid, workers);
  const CellSums sums = sums_on(coarse, cells, feet, most);
  for (std::size_t c = 0; c < coarse.size(); ++c) {
    if (sums.count[c] < 2) continue;
    const double count = sums.count[c], mean = std::abs(sums.sum[c]) / count;
    if (mean > noise && mean * std::sqrt(count) > by_chance * noise)
      report.too_coarse.push_back(mesh.faces[coarse.face(Index(c))].polygon);
  }
  std::sort(report.too_coarse.begin(), report.too_coarse.end());
  report.too_coarse.erase(std::unique(report.too_coarse.begin(), report.too_coarse.end()),
                          report.too_coarse.end());
}

}  // namespace

double covered_within(const Array<Foot>& feet) {
  Array<float> far;
  for (const Foot& foot : feet)
    if (foot.is_used()) far.push_back(std::abs(foot.offset));
  if (far.empty()) return 0;
  const auto at = far.begin() + (far.size() - 1) * 95 / 100;
  std::nth_element(far.begin(), at, far.end());
  return double(*at);
}

double cell_area(const Cells& cells, const double* x, Index cell) {
  const auto& c = cells.corners(cell);
  const Vec3 origin = point_at(x, c[0]);
  const Vec3 along = point_at(x, c[1]) - origin, across = point_at(x, c[2]) - origin;
  const Vec3 normal = c[3] < 0 ? Vec3(along.cross(across))
                               : Vec3(across.cross(point_at(x, c[3]) - point_at(x, c[1])));
  return 0.5 * normal.norm();
}

void measure_fit(const LevelFit& fit, const FairingProblem& problem, FitReport& report) {
  const Cells& cells = fit.cells();
  const ControlMesh& mesh = cells.grid().mesh();
  const double scale = problem.frame.scale;
  Array<Foot> feet = fit.feet();
  // near points have followed the surface; outliers may now be within reach of another part
  fit.finder().find_beyond(2 * spread_of(feet, {}).rms, feet);
  const double rms = spread_of(feet, {}).rms;
  report.noise = rms * scale;
  const double judged = std::max(rms, least_noise * problem.units.edge_in_space);
  report.within = covered_within(feet) * scale;
  report.distances.resize(feet.size());
  report.faces.resize(feet.size());
  for (const std::size_t s : Cancellable(feet.size())) {
    const Foot& foot = feet[s];
    const auto given = std::size_t(fit.scan().given[s]);
    report.faces[given] =
        foot.cell < 0 ? -1 : std::int32_t(mesh.faces[cells.face(foot.cell)].polygon);
    report.distances[given] = foot.cell < 0 ? NAN : fit.finder().distance(s, foot) * scale;
    if (foot.cell < 0 || std::abs(double(foot.offset)) > outlier * judged)
      report.outliers.push_back(std::int64_t(given));
    else if (foot.is_used())
      report.largest = std::max(report.largest, std::abs(report.distances[given]));
  }
  std::sort(report.outliers.begin(), report.outliers.end());
  const double scatter = measure_coverage(cells, feet, *problem.workers,
                                          std::size_t(mesh.input_faces), 2 * judged, report);
  find_too_coarse(cells, feet, *problem.workers,
                  std::max(scatter, least_noise * problem.units.edge_in_space), 2 * judged, report);
}

}  // namespace fairing
