// SPDX-License-Identifier: GPL-3.0-or-later
#include "strain/scatter.h"

#include <Eigen/QR>
#include <cmath>
#include <limits>

#include "base/median.h"
#include "base/roundoff.h"
#include "mesh/normal.h"
#include "parallel/cancel.h"
#include "strain/load_matrix.h"

namespace fairing {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

// The weights of values at these points, one a row, in the value at the first one of the polynomial
// that fits them.
VectorXd value_at_first(const MatrixXd& points, int degree) {
  const double size = points.cwiseAbs().maxCoeff();
  const MatrixXd unit = size > 0 ? MatrixXd(points / size) : points;
  MatrixXd terms(points.rows(), (degree + 1) * (degree + 2) / 2);
  Eigen::Index term = 0;
  for (int d = 0; d <= degree; ++d)
    for (int i = 0; i <= d; ++i)
      terms.col(term++) = unit.col(0).array().pow(i) * unit.col(1).array().pow(d - i);
  const Eigen::ColPivHouseholderQR<MatrixXd> qr(terms);
  const MatrixXd span = qr.householderQ() * MatrixXd::Identity(points.rows(), qr.rank());
  return span * span.row(0).transpose();
}

}  // namespace

Scatter scatter_of(const ControlMesh& mesh, std::span<const Vec3> positions,
                   const std::vector<Index>& vertices, const std::vector<double>& root,
                   const EaseSystem& system) {
  const std::vector<Index> row = numbered(std::size_t(mesh.vertex_count()), vertices);
  Columns moves = Columns::Zero(system.unknowns(), 3);  // from the quartic to the vertex
  std::vector<Eigen::Triplet<double, Index>> entries;
  std::vector<double> deviations;
  // A quartic is the least polynomial that carries an even load.
  constexpr int degree = 4;
  visit_around(mesh, vertices, rings_around, [&](std::size_t i, const std::vector<Index>& around) {
    stop_if_cancelled();
    const Vec3 normal = control_normal(mesh, vertices[i]).stableNormalized();
    if (normal.isZero(0)) return;
    const Vec3 across = normal.unitOrthogonal(), beside = normal.cross(across);
    std::vector<Index> near, loaded;
    for (const Index u : around)
      if (control_normal(mesh, u).dot(normal) > 0) near.push_back(u);
    const auto in_plane = [&](const std::vector<Index>& of) {
      MatrixXd out(Eigen::Index(of.size()), 2);
      for (Eigen::Index k = 0; k < out.rows(); ++k) {
        const Vec3 away = positions[of[k]] - positions[vertices[i]];
        out.row(k) << away.dot(across), away.dot(beside);
      }
      return out;
    };
    VectorXd rest = -value_at_first(in_plane(near), degree);
    rest[0] += 1;
    double distance = 0;
    for (std::size_t k = 0; k < near.size(); ++k) {
      distance += rest[Eigen::Index(k)] * normal.dot(positions[near[k]] - positions[vertices[i]]);
      if (row[near[k]] >= 0) loaded.push_back(near[k]);
    }
    moves.row(Eigen::Index(i)) = root[i] * distance * normal.transpose();
    if (const double own = rest.norm(); own > roundoff)
      deviations.push_back(std::abs(distance) / own);
    const VectorXd share = value_at_first(in_plane(loaded), 1);
    for (std::size_t k = 0; k < loaded.size(); ++k)
      entries.emplace_back(Index(i), row[loaded[k]], share[Eigen::Index(k)]);
  });
  LoadMatrix smooth(moves.rows(), moves.rows());
  smooth.setFromTriplets(entries.begin(), entries.end());
  const VectorXd cubes =
      Eigen::Map<const VectorXd>(root.data(), Eigen::Index(root.size())).array().cube();
  const Columns own = system.matrix() * moves;
  const Columns even = cubes.cwiseInverse().asDiagonal() * (system.loads() - own);
  Scatter out{std::numeric_limits<double>::infinity(),
              own + cubes.asDiagonal() * (smooth * even).eval()};
  // The standard deviation of a median of n absolute values is 1.17 / sqrt(n) of it: three of them.
  if (const auto n = double(deviations.size()); n > 0)
    out.most = (1 + 3.5 / std::sqrt(n)) * deviation_over_median * median(std::move(deviations));
  return out;
}

}  // namespace fairing
