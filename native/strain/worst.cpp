// SPDX-License-Identifier: GPL-3.0-or-later
#include "strain/worst.h"

#include "base/roundoff.h"
#include "parallel/cancel.h"

namespace fairing {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

// The picked rows and columns, and the inverse of their matrix, bordered by one each time.
class Picked {
 public:
  Picked(const LoadMatrix& g, const Columns& loads)
      : g_(g), columns_(g.transpose()), loads_(loads) {}

  // Returns whether the row is independent of the others.
  bool add(Index row) {
    const auto k = Eigen::Index(rows_.size());
    VectorXd above(k), beside(k);
    for (Eigen::Index i = 0; i < k; ++i) {
      above[i] = g_.coeff(rows_[std::size_t(i)], row);
      beside[i] = g_.coeff(row, rows_[std::size_t(i)]);
    }
    const MatrixXd before = inverse_.topLeftCorner(k, k);
    const VectorXd by_column = before * above, by_row = before.transpose() * beside;
    const double own = g_.coeff(row, row), pivot = own - beside.dot(by_column);
    // nothing of its own load remains beside the rows picked before
    if (!(std::abs(pivot) > roundoff * std::abs(own))) return false;
    if (inverse_.rows() == k) inverse_.conservativeResize(2 * k + 1, 2 * k + 1);
    inverse_.topLeftCorner(k, k) = before + by_column * by_row.transpose() / pivot;
    inverse_.block(0, k, k, 1) = -by_column / pivot;
    inverse_.block(k, 0, 1, k) = -by_row.transpose() / pivot;
    inverse_(k, k) = 1 / pivot;
    rows_.push_back(row);
    return true;
  }

  Columns moves() const {
    const auto k = Eigen::Index(rows_.size());
    Columns wanted(k, 3);
    for (Eigen::Index i = 0; i < k; ++i) wanted.row(i) = loads_.row(rows_[std::size_t(i)]);
    return -inverse_.topLeftCorner(k, k) * wanted;
  }

  // The loads after the moves.
  Columns left() const {
    Columns out = loads_;
    const Columns moved = moves();
    for (std::size_t i = 0; i < rows_.size(); ++i)
      for (LoadMatrix::InnerIterator entry(columns_, rows_[i]); entry; ++entry)
        out.row(entry.col()) += entry.value() * moved.row(Eigen::Index(i));
    return out;
  }

  const std::vector<Index>& rows() const { return rows_; }

 private:
  const LoadMatrix& g_;
  const LoadMatrix columns_;  // row j: column j of G
  const Columns& loads_;
  std::vector<Index> rows_;
  MatrixXd inverse_;
};

}  // namespace

Worst moves_of_worst(const LoadMatrix& g, const Columns& loads, const Candidates& candidates) {
  const VectorXd own = g.diagonal();
  std::vector<std::uint8_t> may = candidates.may;
  Picked picked(g, loads);
  Worst out;
  Columns left = loads;
  const auto add = [&](Index row, bool image) {
    may[std::size_t(row)] = 0;
    if (!picked.add(row)) return false;
    out.is_image.push_back(image);
    return true;
  };
  for (Index count = 0; count < candidates.most;) {
    stop_if_cancelled();
    Index worst = -1;
    double largest = 0;
    for (Index j = 0; j < Index(own.size()); ++j) {
      if (!may[std::size_t(j)] || !(own[j] > 0)) continue;
      const double strain = left.row(j).norm() / own[j];
      if (strain > largest) largest = strain, worst = j;
    }
    if (worst < 0) break;
    if (!add(worst, false)) continue;
    ++count;
    for (const Index image : candidates.images[std::size_t(worst)])
      if (image != worst && may[std::size_t(image)]) add(image, true);
    left = picked.left();
  }
  out.rows = picked.rows();
  out.moves = picked.moves();
  return out;
}

}  // namespace fairing
