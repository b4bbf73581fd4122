// SPDX-License-Identifier: GPL-3.0-or-later
// CurvatureLevel::assemble(): J^T J, or J^T L J, as a matrix in double.
//
// Three rows J_a about a control vertex with a large ring are left out of J, and become auxiliary
// unknowns: of u = J_a for total curvature. For minimum variation, with d > 0 the vertex' diagonal
// of L and h = L_ar J_r what its neighbours add to it, the energy
//
//   d |J_a x|^2 + 2 J_a x . h x = |u x|^2 - |w x|^2,   u = (d J_a + h) / sqrt d,   w = h / sqrt d
#include <algorithm>
#include <cmath>

#include "curvature/congruence.h"
#include "curvature/level.h"
#include "sparse/unknown_points.h"

namespace fairing {
namespace {

using Triplets = std::vector<Eigen::Triplet<double>>;

// The rows of J about vertices with large rings.
struct LargeRings {
  std::vector<Index> centre;  // ascending

  // Which of them, or -1.
  Index find(Index p) const {
    const auto at = std::lower_bound(centre.begin(), centre.end(), p);
    return at != centre.end() && *at == p ? Index(at - centre.begin()) : -1;
  }
};

// `apart`: no two of them are neighbours.
LargeRings find_large_rings(const RingJacobian& rows, const std::vector<Index>& number,
                            bool apart) {
  LargeRings large;
  for (Index v = 0; v < rows.grid().mesh().vertex_count(); ++v) {
    std::size_t held = number[std::size_t(v)] >= 0;
    bool alone = true;
    visit_ring(rows.grid(), v, [&](Index q, std::size_t) {
      held += number[std::size_t(q)] >= 0;
      alone &= !apart || large.find(q) < 0;
    });
    if (held > most_coupled && alone) large.centre.push_back(v);
  }
  return large;
}

// Adds to K the auxiliary unknowns whose rows are `u`, then those of `w`, each as many as `rows`.
void border(SparseMatrix& k, Index unknowns, Index rows, const SparseMatrix& u,
            const SparseMatrix& w) {
  Triplets entries;
  const auto add = [&](const SparseMatrix& side, Index first, double diagonal) {
    for (Index c = 0; c < Index(side.cols()); ++c)
      for (SparseMatrix::InnerIterator entry(side, c); entry; ++entry) {
        entries.emplace_back(first + Index(entry.row()), c, entry.value());
        entries.emplace_back(c, first + Index(entry.row()), entry.value());
      }
    for (Index r = 0; r < Index(side.rows()); ++r)
      entries.emplace_back(first + r, first + r, diagonal);
  };
  add(u, unknowns, -1);
  add(w, unknowns + rows, 1);
  SparseMatrix whole(k.rows(), k.cols());
  whole.setFromTriplets(entries.begin(), entries.end());
  k += whole;
}

// L, and a share of W.
SparseMatrix connection_matrix(const RingJacobian& rows, double share) {
  Triplets entries;
  std::size_t count = 0;
  visit_rows(rows, [&](Index, const auto& run, std::size_t, const auto&) {
    count += 3 + 5 * std::size_t(run.slots - 1);
  });
  entries.reserve(count);
  visit_rows(rows, [&](Index p, const RowRun<const float>& run, std::size_t i,
                       const std::vector<Index>& at) {
    for (int c = 0; c < 3; ++c)
      entries.emplace_back(3 * p + c, 3 * p + c, double(run.at(0, 0, i)) + share);
    for (int s = 1; s < run.slots; ++s) {
      const Index q = at[std::size_t(s)];
      const double cosine = run.at(1, s, i), sine = run.at(2, s, i);
      entries.emplace_back(3 * p, 3 * q, double(run.at(0, s, i)));
      entries.emplace_back(3 * p + 1, 3 * q + 1, cosine);
      entries.emplace_back(3 * p + 1, 3 * q + 2, -sine);
      entries.emplace_back(3 * p + 2, 3 * q + 1, sine);
      entries.emplace_back(3 * p + 2, 3 * q + 2, cosine);
    }
  });
  const CountedBytes held(count * sizeof(Triplets::value_type));
  const auto moments = Eigen::Index(3 * rows.grid().size());
  SparseMatrix connection(moments, moments);
  connection.setFromTriplets(entries.begin(), entries.end());
  const CountedBytes twice(2 * matrix_bytes(connection));  // filled by way of its transpose
  return connection;
}

}  // namespace

AssembledSystem CurvatureLevel::assemble() const {
  AssembledSystem system;
  const std::vector<Index> number = number_unknowns(grid_, shared_.unknowns);
  for (std::size_t p = 0; p < number.size(); ++p)
    if (number[p] >= 0) system.unknown_points.push_back(Index(p));
  const LargeRings large = find_large_rings(rows_, number, varies());
  const auto unknowns = Index(system.unknown_points.size()), apart = Index(3 * large.centre.size());
  const Index size = unknowns + (varies() ? 2 : 1) * apart;
  const auto moments = Eigen::Index(3 * grid_.size());
  Triplets entries, of_u, of_w;
  std::vector<double> root(large.centre.size(), 1.0);  // of the diagonal of L
  if (varies())
    for (std::size_t k = 0; k < root.size(); ++k) {
      const RowRun<const float> run =
          variation_->connection->rows().of(vertex_run(large.centre[k]));
      root[k] = std::sqrt(double(run.at(0, 0, 0)) + share_);
    }
  visit_rows(rows_, [&](Index p, const RowRun<const float>& run, std::size_t i,
                        const std::vector<Index>& at) {
    const Index k = large.find(p);
    for (int s = 0; s < run.slots; ++s) {
      const Index column = number[std::size_t(at[std::size_t(s)])];
      for (int c = 0; c < 3 && column >= 0; ++c) {
        const double entry = run.at(c, s, i);
        if (k < 0)
          entries.emplace_back(3 * p + c, column, entry);
        else
          of_u.emplace_back(3 * k + c, column, root[std::size_t(k)] * entry);
      }
    }
  });
  SparseMatrix jacobian(moments, size);
  jacobian.setFromTriplets(entries.begin(), entries.end());
  entries = {};
  const MatrixBytes held(jacobian);
  if (varies()) {
    const SparseMatrix connection = connection_matrix(variation_->connection->rows(), share_);
    const MatrixBytes connection_held(connection);
    const auto take_turned = [&](Index c, Index row, double entry) {
      const Index k = large.find(row / 3);
      if (k < 0 || !(root[std::size_t(k)] > 0)) return;
      of_u.emplace_back(3 * k + row % 3, c, entry / root[std::size_t(k)]);
      of_w.emplace_back(3 * k + row % 3, c, entry / root[std::size_t(k)]);
    };
    congruence(jacobian, &connection, apart > 0 ? take_turned : TurnedEntry{}).swap(system.matrix);
  } else {
    congruence(jacobian, nullptr, {}).swap(system.matrix);
  }
  const MatrixBytes matrix_held(system.matrix);
  if (apart > 0) {
    SparseMatrix u(apart, unknowns), w(varies() ? apart : 0, unknowns);
    u.setFromTriplets(of_u.begin(), of_u.end());
    w.setFromTriplets(of_w.begin(), of_w.end());
    border(system.matrix, unknowns, apart, u, w);
    system.negative = apart;
  }
  if (is_tense()) {
    entries.clear();
    area_->add_entries(number, entries);
    SparseMatrix area(size, size);
    area.setFromTriplets(entries.begin(), entries.end());
    system.matrix += area;
  }
  const Eigen::VectorXd diagonal = system.diagonal();
  for (Eigen::Index i = 0; i < unknowns; ++i) {
    const auto p = std::size_t(system.unknown_points[std::size_t(i)]);
    double extra = diagonal(i) > 0 ? 0.0 : 1.0;
    if (p < weights_.size()) extra += weight(p);
    if (!damping_.empty()) extra += double(damping_[p]);
    if (extra > 0) system.matrix.coeffRef(i, i) += extra;
  }
  return system;
}

}  // namespace fairing
