// SPDX-License-Identifier: GPL-3.0-or-later
#include "fair/harmonic_fill.h"

#include <Eigen/Geometry>
#include <Eigen/SparseLU>
#include <cmath>

#include "lattice/ring.h"

namespace fairing {
namespace {

using Map = Eigen::Map<const Vec3>;
using Matrix = Eigen::SparseMatrix<double>;

// A point's ring without the far corners of quads.
struct Ring {
  std::vector<Index> points;
  bool closed = true;
};

// Calls visit(point, ring) for the marked unknowns; `ring` is reused.
template <class Visit>
void visit_marked(const Lattice& lattice, const Unknowns& unknowns, const Array<float>& marks,
                  Visit&& visit) {
  const ControlMesh& mesh = lattice.mesh();
  const int n = lattice.n();
  Ring ring;
  std::vector<Index> all;
  const auto marked = [&](Index p) { return marks[std::size_t(p)] > 0; };
  for (Index v = 0; v < mesh.vertex_count(); ++v) {
    if (!unknowns.vertex[std::size_t(v)] || !marked(v)) continue;
    ring = {{}, mesh.interior(v)};
    visit_ring(lattice, v, [&](Index p, std::size_t slot) {
      if (slot % 2 == 0) ring.points.push_back(p);
    });
    visit(v, ring);
  }
  for (Index e = 0; e < Index(mesh.edges.size()) && n > 1; ++e) {
    if (!unknowns.edge[std::size_t(e)]) continue;
    const EdgeRingLanes lanes(mesh, e);
    const Edge& edge = mesh.edges[std::size_t(e)];
    const std::size_t size = std::size_t(lanes.size), start = edge.side[0] < 0 ? 1 : 0;  // open: from the rim
    for (int k = 1; k < n; ++k) {
      if (!marked(lattice.edge_point(e, k))) continue;
      all.clear();
      append_ring(lattice, e, lanes, k, all);
      ring = {{}, !edge.boundary()};
      for (std::size_t j = 0; j < size; ++j)
        if (!lanes.far[(start + j) % size]) ring.points.push_back(all[(start + j) % size]);
      visit(lattice.edge_point(e, k), ring);
    }
  }
  for (Index f = 0; f < Index(mesh.faces.size()); ++f) {
    if (!unknowns.has_face(std::size_t(f))) continue;
    const bool quad = mesh.faces[std::size_t(f)].quad();
    Index p = lattice.face_base(f);
    for (int j = 1; j < n; ++j)
      for (int i = 1; i < (quad ? n : n - j); ++i, ++p) {
        if (!marked(p)) continue;
        all.clear();
        append_ring(lattice, f, LatticePoint{i, j}, all);
        ring = {{}, true};
        for (std::size_t s = 0; s < all.size(); s += quad ? 2 : 1) ring.points.push_back(all[s]);
        visit(p, ring);
      }
  }
}

// tan(angle / 2) between two directions.
double half_tangent(const Vec3& a, const Vec3& b) {
  return std::tan(std::atan2(a.cross(b).norm(), a.dot(b)) / 2);
}

// Sums to one.
void mean_value_weights(const double* shape, Index point, const Ring& ring, std::vector<double>& weights) {
  const std::size_t size = ring.points.size();
  const auto offset = [&](std::size_t j) {
    return Vec3(Map(shape + 3 * std::size_t(ring.points[j])) - Map(shape + 3 * std::size_t(point)));
  };
  weights.assign(size, 0.0);
  for (std::size_t j = 0; j + (ring.closed ? 0 : 1) < size; ++j) {
    const std::size_t after = (j + 1) % size;
    const double t = half_tangent(offset(j), offset(after));
    weights[j] += t;
    weights[after] += t;
  }
  double total = 0;
  for (std::size_t j = 0; j < size; ++j) total += weights[j] /= offset(j).norm();
  for (double& w : weights) w /= total;
}

}  // namespace

void fill_harmonically(const Lattice& lattice, const Unknowns& unknowns, const Array<float>& marks,
                       const double* shape, double* x) {
  std::vector<Index> filled;
  visit_marked(lattice, unknowns, marks, [&](Index p, const Ring&) { filled.push_back(p); });
  if (filled.empty()) return;
  std::sort(filled.begin(), filled.end());
  const auto number_of = [&](Index p) {
    const auto at = std::lower_bound(filled.begin(), filled.end(), p);
    return at != filled.end() && *at == p ? Eigen::Index(at - filled.begin()) : Eigen::Index(-1);
  };
  const auto size = Eigen::Index(filled.size());
  std::vector<Eigen::Triplet<double>> entries;
  Eigen::MatrixX3d known = Eigen::MatrixX3d::Zero(size, 3);
  std::vector<double> weights;
  visit_marked(lattice, unknowns, marks, [&](Index p, const Ring& ring) {
    const Eigen::Index row = number_of(p);
    entries.emplace_back(row, row, 1.0);
    mean_value_weights(shape, p, ring, weights);
    for (std::size_t j = 0; j < weights.size(); ++j) {
      const Eigen::Index column = number_of(ring.points[j]);
      if (column >= 0)
        entries.emplace_back(row, column, -weights[j]);
      else
        known.row(row) += weights[j] * Map(x + 3 * std::size_t(ring.points[j])).transpose();
    }
  });
  Matrix matrix(size, size);
  matrix.setFromTriplets(entries.begin(), entries.end());
  Eigen::SparseLU<Matrix> factor(matrix);
  if (factor.info() != Eigen::Success) return;
  const Eigen::MatrixX3d places = factor.solve(known);
  for (Eigen::Index i = 0; i < size; ++i)
    for (Eigen::Index a = 0; a < 3; ++a)
      x[3 * std::size_t(filled[std::size_t(i)]) + std::size_t(a)] = places(i, a);
}

}  // namespace fairing
