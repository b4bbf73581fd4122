// SPDX-License-Identifier: GPL-3.0-or-later
#include "strain/worst.h"

#include <Eigen/QR>
#include <algorithm>
#include <functional>

#include "parallel/cancel.h"

namespace fairing {

std::vector<Index> worst_rows(const std::vector<double>& lengths, std::size_t count,
                              const std::vector<std::vector<Index>>& images) {
  std::vector<Index> rows, out;
  for (std::size_t i = 0; i < lengths.size(); ++i)
    if (lengths[i] > 0) rows.push_back(Index(i));
  std::ranges::stable_sort(rows, std::greater(), [&](Index i) { return lengths[i]; });
  std::vector<std::uint8_t> taken(lengths.size());
  for (const Index row : rows) {
    if (out.size() == count) break;
    if (taken[row]) continue;
    out.push_back(row);
    for (const Index image : images[row]) taken[image] = 1;
  }
  return out;
}

Columns moves_without_loads(const LoadMatrix& g, const Columns& loads,
                            std::span<const Index> rows) {
  const auto k = Eigen::Index(rows.size());
  Columns own(k, 3);
  if (rows.empty()) return own;
  Eigen::MatrixXd part(k, k);
  for (Eigen::Index i = 0; i < k; ++i) {
    stop_if_cancelled();
    own.row(i) = -loads.row(rows[i]);
    for (Eigen::Index j = 0; j < k; ++j) part(i, j) = g.coeff(rows[i], rows[j]);
  }
  return part.colPivHouseholderQr().solve(own);  // without pivots that are rounding
}

}  // namespace fairing
