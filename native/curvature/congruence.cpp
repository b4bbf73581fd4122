// SPDX-License-Identifier: GPL-3.0-or-later
#include "curvature/congruence.h"

#include <algorithm>
#include <cstdint>
#include <vector>

namespace fairing {
namespace {

// A sparse column as it is summed up.
class Column {
 public:
  explicit Column(Eigen::Index rows) : value_(std::size_t(rows)), used_(std::size_t(rows)) {}

  void clear() {
    for (const Index r : rows_) used_[std::size_t(r)] = 0;
    rows_.clear();
  }

  void add(const SparseMatrix& matrix, Index column, double factor) {
    for (SparseMatrix::InnerIterator entry(matrix, column); entry; ++entry) {
      const auto r = std::size_t(entry.row());
      if (!used_[r]) {
        used_[r] = 1;
        value_[r] = entry.value() * factor;
        rows_.push_back(Index(r));
      } else {
        value_[r] += entry.value() * factor;
      }
    }
  }

  void sort() { std::sort(rows_.begin(), rows_.end()); }
  const std::vector<Index>& rows() const { return rows_; }
  double operator[](Index row) const { return value_[std::size_t(row)]; }

 private:
  std::vector<double> value_;
  std::vector<std::uint8_t> used_;
  std::vector<Index> rows_;
};

// Room for one more column: once it is needed, for all that are left, if they are as full as those
// so far.
void make_room(SparseMatrix& matrix, Eigen::Index column, std::size_t entries) {
  auto& numbers = matrix.data();
  const auto now = std::size_t(numbers.size());
  if (now + entries <= std::size_t(numbers.allocatedSize())) return;
  const double mean = double(now + entries) / double(column + 1);
  numbers.reserve(Eigen::Index(entries + std::size_t(mean * double(matrix.cols() - column - 1))));
}

}  // namespace

SparseMatrix congruence(const SparseMatrix& jacobian, const SparseMatrix* middle,
                        const TurnedEntry& take_turned) {
  const SparseMatrix transposed = jacobian.transpose();
  const MatrixBytes held(transposed);
  SparseMatrix out(jacobian.cols(), jacobian.cols());
  Column turned(middle ? jacobian.rows() : 0), product(jacobian.cols());
  for (Index c = 0; c < Index(jacobian.cols()); ++c) {
    product.clear();
    if (middle) {
      turned.clear();
      for (SparseMatrix::InnerIterator entry(jacobian, c); entry; ++entry)
        turned.add(*middle, Index(entry.row()), entry.value());
      turned.sort();
      for (const Index r : turned.rows()) {
        product.add(transposed, r, turned[r]);
        if (take_turned) take_turned(c, r, turned[r]);
      }
    } else {
      for (SparseMatrix::InnerIterator entry(jacobian, c); entry; ++entry)
        product.add(transposed, Index(entry.row()), entry.value());
    }
    product.sort();
    make_room(out, c, product.rows().size());
    out.startVec(c);
    for (const Index r : product.rows()) out.insertBackByOuterInner(c, r) = product[r];
  }
  out.finalize();
  out.data().squeeze();
  const MatrixBytes out_held(out);
  return out;
}

}  // namespace fairing
