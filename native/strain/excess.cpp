// SPDX-License-Identifier: GPL-3.0-or-later
#include "strain/excess.h"

#include <cmath>
#include <map>
#include <queue>

#include "parallel/cancel.h"

namespace fairing {
namespace {

using Way = Eigen::RowVector3d;

class Releases {
 public:
  Releases(const StrainSystem& of, const Columns& loads, const std::vector<double>& floors)
      : of_(of), columns_(of.matrix.transpose()), left_(loads), floors_(floors) {
    const Eigen::VectorXd own = of.matrix.diagonal();
    const Eigen::VectorXd inverse =
        own.unaryExpr([](double load) { return load > 0 ? 1 / load : 0.0; });
    columns_ = columns_ * inverse.asDiagonal();
    left_ = -(inverse.asDiagonal() * loads);
    gone_.assign(std::size_t(loads.rows()), 0);
    for (Index j = 0; j < Index(loads.rows()); ++j) {
      double stiffness = 1;
      for (const Index image : images_of(j))
        if (image != j) stiffness += cosine_of(j, image) * columns_.coeff(image, j);
      with_images_.push_back(1 / stiffness);
    }
  }

  Columns run() {
    Columns out = Columns::Zero(left_.rows(), 3);
    for (Index j = 0; j < Index(left_.rows()); ++j) offer(j);
    while (!longest_.empty()) {
      stop_if_cancelled();
      const auto [length, first] = longest_.top();
      longest_.pop();
      if (!is_free(first) || length != length_of(first)) continue;
      const Index j = row_to_release(first);
      for (const Index row : images_of(j)) {
        out.row(row) = way(row);
        gone_[row] = 1;
      }
      for (const auto& [row, change] : changes(j)) {
        left_.row(row) += change;
        offer(row);
      }
      offer(first);
    }
    for (Index j = 0; j < Index(left_.rows()); ++j)
      if (is_free(j)) out.row(j) = way(j);
    return out;
  }

 private:
  const std::vector<Index>& images_of(Index j) const { return of_.images[j]; }
  bool is_free(Index j) const { return !gone_[j]; }
  double cosine_of(Index j, Index image) const {
    const Way normal = of_.normals.row(j);
    return normal.isZero(0) ? 1.0 : normal.dot(of_.normals.row(image));
  }
  // The way of a row that is released with its images.
  Way way(Index j) const { return with_images_[j] * left_.row(j); }
  double length_of(Index j) const { return way_length(way(j), of_.normals.row(j)); }
  void offer(Index j) {
    if (!is_free(j)) return;
    if (const double length = length_of(j); length > floors_[j]) longest_.emplace(length, j);
  }

  // Changes of all ways when a row and its images are released.
  std::map<Index, Way> changes(Index j) const {
    std::map<Index, Way> out;
    for (const Index from : images_of(j))
      for (LoadMatrix::InnerIterator entry(columns_, from); entry; ++entry)
        out.try_emplace(Index(entry.col()), Way::Zero()).first->second -= entry.value() * way(from);
    return out;
  }

  // A row between rows that are images of each other is strained by all of them, more than they
  // are. Returns the one, among it and such rows, whose release leaves the smallest sum.
  Index row_to_release(Index longest) const {
    Index best = longest;
    double least = left_without(longest);
    for (LoadMatrix::InnerIterator entry(columns_, longest); entry; ++entry) {
      const auto j = Index(entry.col());
      if (images_of(j).size() <= images_of(longest).size()) continue;
      if (!is_free(j) || !(length_of(j) > floors_[j])) continue;
      if (const double left = left_without(j); left < least) least = left, best = j;
    }
    return best;
  }

  // Sum of the lengths of all ways after the release.
  double left_without(Index j) const {
    double left = 0;
    for (const auto& [row, change] : changes(j)) {
      const Way normal = of_.normals.row(row), before = left_.row(row);
      left += way_length(before + change, normal) - way_length(before, normal);
    }
    return left;
  }

  const StrainSystem& of_;
  LoadMatrix columns_;  // row j: the ways that a whole way of j removes from the others
  Columns left_;
  const std::vector<double>& floors_;
  std::vector<std::uint8_t> gone_;
  std::vector<double> with_images_;
  std::priority_queue<std::pair<double, Index>> longest_;  // with lengths at the time of insertion
};

}  // namespace

double way_length(const Way& way, const Way& normal) {
  return normal.isZero(0) ? way.norm() : std::abs(way.dot(normal));
}

Columns ways_one_by_one(const StrainSystem& of, const Columns& loads,
                        const std::vector<double>& floors) {
  return Releases(of, loads, floors).run();
}

}  // namespace fairing
