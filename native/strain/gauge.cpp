// SPDX-License-Identifier: GPL-3.0-or-later
#include "strain/gauge.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/median.h"
#include "mesh/mend/mend.h"
#include "mesh/normal.h"
#include "strain/excess.h"

namespace fairing {
namespace {

// The floor, in standard deviations: of a thousand strains of pure scatter three are larger.
constexpr double deviations_out = 3;

}  // namespace

void restore(Ways& ways, const std::vector<Index>& origin) {
  give_to_merged(origin, ways.ways);
  give_to_merged(origin, ways.lengths);
}

void restore(Excess& excess, const std::vector<Index>& origin) {
  restore(excess.own, origin);
  give_to_merged(origin, excess.wrong);
}

StrainGauge::StrainGauge(const FairingProblem& problem, FairingSystems& systems, int rings_apart,
                         const OnPart& on_part)
    : problem_(problem), curves_(problem.mesh, problem.basis.working, problem.exponent) {
  const ControlMesh& mesh = problem.mesh;
  if (const Pads* const pads = systems.plate().pads()) {
    for (Index v = 0; v < mesh.input_vertices; ++v)
      if (pads->under(std::size_t(v))) vertices_.push_back(v);
    on_pads_ = vertices_.size();
    counted_.emplace(bytes_of_load_matrix(on_pads_, rings_apart));
    ProbedMatrix probed = load_matrix(systems, vertices_, rings_apart, on_part);
    matrix_ = std::move(probed.g);
    solves_ = probed.solves;
  }
  add_curve_rows();
  normals_ = Columns::Zero(Eigen::Index(vertices_.size()), 3);
  for (std::size_t i = 0; i < on_pads_; ++i)
    normals_.row(Eigen::Index(i)) = control_normal(mesh, vertices_[i]).stableNormalized();
  // A mesh that is its own mirror image has each error twice.
  const std::vector<Index> row = row_of_vertices();
  for (const Index v : vertices_) {
    std::vector<Index>& images = images_.emplace_back();
    for (const Index image : problem.symmetry.images(v))
      if (row[image] >= 0) images.push_back(row[image]);
  }
}

void StrainGauge::require_room(const FairingProblem& problem, int rings_apart,
                               std::size_t surface) {
  const auto vertices = std::size_t(problem.mesh.input_vertices);
  const std::size_t matrix = bytes_of_load_matrix(vertices, rings_apart);
  if (surface + matrix <= problem.options.bytes_allowed()) return;
  throw FairingError(ErrorCode::too_large,
                     {"The loads that " + std::to_string(vertices) + " vertices ask for take " +
                          std::to_string(matrix / 1000000) + " MB beside the surface's " +
                          std::to_string(surface / 1000000) + ", over the limit.",
                      "Raise memory_limit, or ease parts of the mesh."});
}

// Adds the springs to the matrix of loads on pads.
void StrainGauge::add_curve_rows() {
  for (const Index v : curves_.middles())
    if (problem_.mesh.vertex_part(v) == RegionPart::inside) vertices_.push_back(v);
  curve_matrix_ = LoadMatrix(curves_.differences().transpose()) * curves_.differences();
  const std::vector<Index> row = row_of_vertices();
  std::vector<Eigen::Triplet<double, Index>> entries;
  const auto n = Eigen::Index(vertices_.size());
  for (Eigen::Index i = Eigen::Index(on_pads_); i < n; ++i)
    for (LoadMatrix::InnerIterator entry(curve_matrix_, vertices_[i]); entry; ++entry)
      if (const Index column = row[entry.col()]; column >= Index(on_pads_))
        entries.emplace_back(Index(i), column, entry.value());
  LoadMatrix own(n, n);
  own.setFromTriplets(entries.begin(), entries.end());
  matrix_.conservativeResize(n, n);
  matrix_ += own;
}

Columns StrainGauge::loads(const Loads& on_pads, const ControlPositions& control) const {
  Columns out(Eigen::Index(vertices_.size()), 3);
  for (std::size_t i = 0; i < on_pads_; ++i)
    out.row(Eigen::Index(i)) = on_pads[vertices_[i]].transpose();
  const Columns on_curves = curve_matrix_ * columns_of(control.working);
  for (std::size_t i = on_pads_; i < vertices_.size(); ++i)
    out.row(Eigen::Index(i)) = on_curves.row(vertices_[i]);
  return out;
}

Columns StrainGauge::ways_of(Columns loads) const {
  for (Eigen::Index i = 0; i < loads.rows(); ++i) {
    const double own = matrix_.coeff(i, i);
    loads.row(i) *= own > 0 ? -1 / own : 0.0;
  }
  return loads;
}

Ways StrainGauge::in_mesh_units(const Columns& ways) const {
  const auto n = std::size_t(problem_.mesh.input_vertices);
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  Ways out{std::vector<Vec3>(n, Vec3::Constant(none)), std::vector<double>(n, none)};
  for (std::size_t i = 0; i < vertices_.size(); ++i) {
    if (!(matrix_.coeff(Eigen::Index(i), Eigen::Index(i)) > 0)) continue;
    const auto v = std::size_t(vertices_[i]);
    const Vec3 way = problem_.frame.scale * ways.row(Eigen::Index(i)).transpose();
    const double along = way.dot(control_normal(problem_.mesh, Index(v)).stableNormalized());
    out.ways[v] = way;
    out.lengths[v] = i < on_pads_ ? along : std::copysign(way.norm(), along);
  }
  return out;
}

Ways StrainGauge::strain(const Loads& on_pads, const ControlPositions& control) const {
  return in_mesh_units(ways_of(loads(on_pads, control)));
}

// NaN if there is no strain.
std::vector<double> StrainGauge::lengths_of(const Columns& ways) const {
  std::vector<double> out(vertices_.size(), std::numeric_limits<double>::quiet_NaN());
  for (Eigen::Index i = 0; i < ways.rows(); ++i)
    if (matrix_.coeff(i, i) > 0) out[i] = way_length(ways.row(i), normals_.row(i));
  return out;
}

// Next to a curve shapes have more strain than inside (strain/border_moments.h).
std::vector<std::vector<Index>> StrainGauge::rows_of_same_kind() const {
  const ControlMesh& mesh = problem_.mesh;
  const std::vector<Index> row = row_of_vertices();
  // a polygon's centre has no pad and is not on a curve
  const auto off_pads = [&](Index u) {
    const Index r = row[u];
    return u < mesh.input_vertices && (r < 0 || r >= Index(on_pads_));
  };
  enum Kind { inside, beside_curve, on_curve };
  std::vector<Kind> kinds(vertices_.size());
  visit_around(mesh, vertices_, 1, [&](std::size_t i, const std::vector<Index>& around) {
    const bool beside = std::any_of(around.begin(), around.end(), off_pads);
    kinds[i] = i >= on_pads_ ? on_curve : beside ? beside_curve : inside;
  });
  std::vector<std::vector<Index>> out(vertices_.size());
  visit_around(mesh, vertices_, rings_around, [&](std::size_t i, const std::vector<Index>& around) {
    for (const Index u : around)
      if (const Index r = row[u]; r >= 0 && std::size_t(r) != i && kinds[r] == kinds[i])
        out[i].push_back(r);
  });
  return out;
}

// The floor of each row, from nearby rows of the same kind.
std::vector<double> StrainGauge::floors_of(const std::vector<double>& lengths, double floor) const {
  std::vector<double> out(vertices_.size(), floor);
  const std::vector<std::vector<Index>> rows = rows_of_same_kind();
  for (std::size_t i = 0; i < rows.size(); ++i) {
    std::vector<double> known;
    for (const Index r : rows[i])
      if (!std::isnan(lengths[r])) known.push_back(lengths[r]);
    out[i] = std::max(floor, deviations_out * deviation_over_median * median(std::move(known)));
  }
  return out;
}

Excess StrainGauge::excess(const Loads& on_pads, const ControlPositions& control) const {
  const Columns all = loads(on_pads, control);
  std::vector<double> known;
  double largest = 0;
  for (const double length : lengths_of(ways_of(all))) {
    if (std::isnan(length)) continue;
    known.push_back(length);
    largest = std::max(largest, length);
  }
  // The error of solves is a floor too.
  const double floor = std::max(deviations_out * deviation_over_median * median(std::move(known)),
                                problem_.options.solve.relative_residual * largest);
  const StrainSystem straining{matrix_, normals_, images_};
  const std::vector<double> alone =
      lengths_of(ways_one_by_one(straining, all, std::vector<double>(vertices_.size(), floor)));
  // Only outliers are released: in an evenly strained shape each release strains the next vertex.
  std::vector<double> floors = floors_of(alone, floor);
  for (std::size_t i = 0; i < floors.size(); ++i)
    if (!(alone[i] > floors[i])) floors[i] = std::numeric_limits<double>::infinity();
  const Columns own = ways_one_by_one(straining, all, floors);
  const std::vector<double> lengths = lengths_of(own);
  Excess out{in_mesh_units(own), floor * problem_.frame.scale,
             std::vector<std::uint8_t>(std::size_t(problem_.mesh.input_vertices), 0)};
  for (std::size_t i = 0; i < vertices_.size(); ++i)
    out.wrong[vertices_[i]] = lengths[i] > floors[i];
  return out;
}

}  // namespace fairing
