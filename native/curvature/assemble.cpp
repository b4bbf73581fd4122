// SPDX-License-Identifier: GPL-3.0-or-later
// CurvatureLevel::assemble(): J^T J, or J^T L J, as a matrix in double.
#include <optional>

#include "curvature/level.h"
#include "multigrid/assembly.h"
#include "sparse/unknown_points.h"

namespace fairing {
namespace {

// L + share W.
SparseMatrix connection_matrix(const RingRows& rows, double share) {
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
      const Index q = at[s];
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
  const CountedBytes twice(2 * matrix_bytes(connection));  // filled through its transpose
  return connection;
}

}  // namespace

AssembledSystem CurvatureLevel::assemble() const {
  const std::vector<Index> number = number_unknowns(grid_, shared_.unknowns);
  std::optional<SparseMatrix> connection;
  if (varies()) connection = connection_matrix(variation_->connection->rows(), share_);
  const CountedBytes held(connection ? matrix_bytes(*connection) : 0);
  std::vector<double> numbers;
  AssembledSystem system = assemble_square(
      grid_, number, connection ? &*connection : nullptr, [&](const VisitRows& visit) {
        visit_rows(rows_, [&](Index, const RowRun<const float>& run, std::size_t i,
                              const std::vector<Index>& ring) {
          numbers.clear();
          for (int s = 0; s < run.slots; ++s)
            for (int c = 0; c < 3; ++c) numbers.push_back(run.at(c, s, i));
          visit(ring, numbers);
        });
      });
  if (is_tense()) {
    Triplets entries;
    area_->add_entries(number, entries);
    add_entries(entries, system);
  }
  const Eigen::VectorXd diagonal = system.diagonal();
  for (Eigen::Index i = 0; i < Eigen::Index(system.unknown_points.size()); ++i) {
    const auto p = std::size_t(system.unknown_points[i]);
    double extra = diagonal(i) > 0 ? 0.0 : 1.0;
    if (p < weights_.size()) extra += weight(p);
    extra += added_to_diagonal(p);
    if (extra > 0) system.matrix.coeffRef(i, i) += extra;
  }
  return system;
}

}  // namespace fairing
