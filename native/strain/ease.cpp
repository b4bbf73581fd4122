// SPDX-License-Identifier: GPL-3.0-or-later
#include "strain/ease.h"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "parallel/cancel.h"

namespace fairing {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr Index krylov_steps = 12;
// Up to so many vertices all columns of G are solved for, three at a time.
constexpr Index all_columns = 96;
// Amounts that are tried, times the mean eigenvalue of G: ten a decade.
constexpr double least_amount = 1e-3, ten_a_decade = 1.2589254117941673;
constexpr int amounts = 61;

// G on a space with an orthonormal basis, as a matrix, and the vector that the space is for.
struct Projected {
  MatrixXd basis;  // empty: all vectors
  MatrixXd g;
  VectorXd start;
};

// s^2 H (I + s^2 H^2)^-1 v
VectorXd filtered(const MatrixXd& h, double s, const VectorXd& v) {
  MatrixXd m = s * s * h * h;
  m.diagonal().array() += 1;
  return s * s * (h * m.partialPivLu().solve(v));
}

// Arnoldi's steps from three vectors, each in a space of its own.
std::array<Projected, 3> krylov(const LoadsOfMoves& loads_of, const Columns& from, int& solves) {
  const Index n = from.rows(), steps = std::min(n, krylov_steps);
  std::array<Projected, 3> spaces;
  std::array<Index, 3> size{};
  for (int a = 0; a < 3; ++a) {
    Projected& space = spaces[std::size_t(a)];
    space.basis = MatrixXd::Zero(n, steps);
    space.g = MatrixXd::Zero(steps, steps);
    space.start = VectorXd::Zero(steps);
    const double length = from.col(a).norm();
    if (!(length > 0)) continue;
    space.basis.col(0) = from.col(a) / length;
    space.start[0] = length;
    size[std::size_t(a)] = 1;
  }
  for (Index k = 0; k < steps; ++k) {
    Columns at = Columns::Zero(n, 3);
    bool any = false;
    for (int a = 0; a < 3; ++a) {
      if (size[std::size_t(a)] <= k) continue;
      at.col(a) = spaces[std::size_t(a)].basis.col(k);
      any = true;
    }
    if (!any) break;
    Columns next = loads_of(at);
    ++solves;
    for (int a = 0; a < 3; ++a) {
      if (size[std::size_t(a)] <= k) continue;
      Projected& space = spaces[std::size_t(a)];
      VectorXd v = next.col(a);
      const double before = v.norm();
      for (int again = 0; again < 2; ++again)  // the second time for rounding
        for (Index i = 0; i <= k; ++i) {
          const double part = space.basis.col(i).dot(v);
          space.g(i, k) += part;
          v -= part * space.basis.col(i);
        }
      const double left = v.norm();
      if (k + 1 == steps || !(left > 1e-6 * before)) continue;
      space.g(k + 1, k) = left;
      space.basis.col(k + 1) = v / left;
      size[std::size_t(a)] = k + 2;
    }
  }
  for (int a = 0; a < 3; ++a) {
    Projected& space = spaces[std::size_t(a)];
    const Index kept = size[std::size_t(a)];
    space.basis.conservativeResize(n, kept);
    space.g.conservativeResize(kept, kept);
    space.start.conservativeResize(kept);
  }
  return spaces;
}

MatrixXd all_of(const LoadsOfMoves& loads_of, Index n, int& solves) {
  MatrixXd g(n, n);
  for (Index first = 0; first < n; first += 3) {
    Columns units = Columns::Zero(n, 3);
    const Index count = std::min<Index>(3, n - first);
    for (Index a = 0; a < count; ++a) units(first + a, a) = 1;
    g.middleCols(first, count) = loads_of(units).leftCols(count);
    ++solves;
  }
  return g;
}

// Signs by Steele's splitmix64.
Columns random_signs(Index n) {
  Columns out(n, 3);
  std::uint64_t state = 1;
  for (Index a = 0; a < 3; ++a)
    for (Index i = 0; i < n; ++i) {
      std::uint64_t z = state += 0x9e3779b97f4a7c15u;
      z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
      z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
      out(i, a) = (z ^ (z >> 31)) & 1 ? 1.0 : -1.0;
    }
  return out;
}

// The moves and the trace for any amount.
class Filter {
 public:
  Filter(const LoadsOfMoves& loads_of, const Columns& loads, bool traces) : n_(loads.rows()) {
    if (n_ <= all_columns) {
      all_ = all_of(loads_of, n_, solves_);
      loads_ = loads;
      mean_ = all_.trace() / double(n_);
      return;
    }
    of_loads_ = krylov(loads_of, loads, solves_);
    // A bound needs no trace, but amounts have a unit.
    if (traces) of_signs_ = krylov(loads_of, random_signs(n_), solves_);
    double sum = 0, count = 0;
    for (const Projected& space : traces ? of_signs_ : of_loads_)
      if (space.start.size() > 0) sum += space.g(0, 0), ++count;
    mean_ = count > 0 ? sum / count : 0;
  }

  Columns moves(double s) const {
    Columns out = Columns::Zero(n_, 3);
    for (int a = 0; a < 3; ++a) {
      if (all_.size() > 0) {
        out.col(a) = -filtered(all_, s, loads_.col(a));
      } else if (const Projected& space = of_loads_[std::size_t(a)]; space.start.size() > 0) {
        out.col(a) = -(space.basis * filtered(space.g, s, space.start));
      }
    }
    return out;
  }
  // Of I - (I + s^2 G^2)^-1.
  double trace(double s) const {
    if (all_.size() > 0) {
      MatrixXd squared = s * s * all_ * all_, m = squared;
      m.diagonal().array() += 1;
      return m.partialPivLu().solve(squared).trace();
    }
    double sum = 0;
    for (const Projected& space : of_signs_)
      sum += space.start.dot(space.g * filtered(space.g, s, space.start));
    return sum / 3;
  }
  double mean() const { return mean_; }
  int solves() const { return solves_; }

 private:
  Index n_;
  MatrixXd all_;  // empty: Krylov's spaces
  Columns loads_;
  std::array<Projected, 3> of_loads_, of_signs_;
  double mean_ = 0;
  int solves_ = 0;
};

bool within(const Columns& moves, const VectorXd& bounds) {
  return (moves.rowwise().norm().array() <= bounds.array()).all();
}

double largest_within(const Filter& filter, const VectorXd& bounds) {
  double low = 0, high = least_amount / filter.mean();
  for (int i = 0; i < amounts && within(filter.moves(high), bounds); ++i) {
    low = high;
    high *= ten_a_decade;
  }
  if (low == 0) return low;
  for (int i = 0; i < 20; ++i) {
    stop_if_cancelled();
    const double middle = 0.5 * (low + high);
    (within(filter.moves(middle), bounds) ? low : high) = middle;
  }
  return low;
}

double cross_validated(const Filter& filter) {
  double best = 0, least = std::numeric_limits<double>::infinity();
  double s = least_amount / filter.mean();
  for (int i = 0; i < amounts; ++i, s *= ten_a_decade) {
    stop_if_cancelled();
    const double left = filter.moves(s).norm() / filter.trace(s);
    if (left < least) {
      least = left;
      best = s;
    }
  }
  return best;
}

}  // namespace

Eased ease(const LoadsOfMoves& loads_of, const Columns& loads, const VectorXd& bounds) {
  const bool bounded = bounds.size() > 0;
  Eased out;
  out.moves = Columns::Zero(loads.rows(), 3);
  if (loads.rows() == 0 || !(loads.norm() > 0)) return out;
  const Filter filter(loads_of, loads, true);
  out.solves = filter.solves();
  if (!(filter.mean() > 0)) return out;
  const double s = bounded ? largest_within(filter, bounds) : cross_validated(filter);
  if (!(s > 0)) return out;
  out.moves = filter.moves(s);
  out.amount = s * filter.mean();
  out.noise = out.moves.norm() / std::sqrt(filter.trace(s));
  return out;
}

Eased ease_worst(const LoadsOfMoves& loads_of, const Columns& loads, const VectorXd& own,
                 int most) {
  const Index n = loads.rows();
  Eased out;
  out.moves = Columns::Zero(n, 3);
  Columns left = loads;
  std::vector<Index> picked;
  MatrixXd columns(n, 0);  // of G, one a picked row
  while (Index(picked.size()) < std::min<Index>(most, n)) {
    VectorXd strain = left.rowwise().norm().array() / own.array();
    for (const Index j : picked) strain[j] = 0;
    Index worst = 0;
    if (!(strain.maxCoeff(&worst) > 0)) break;
    picked.push_back(worst);
    Columns unit = Columns::Zero(n, 3);
    unit(worst, 0) = 1;
    columns.conservativeResize(n, Index(picked.size()));
    columns.rightCols(1) = loads_of(unit).col(0);
    ++out.solves;
    const MatrixXd among = columns(picked, Eigen::all);
    const MatrixXd moves = -among.partialPivLu().solve(MatrixXd(loads(picked, Eigen::all)));
    left = loads + columns * moves;
    for (std::size_t i = 0; i < picked.size(); ++i) out.moves.row(picked[i]) = moves.row(Index(i));
  }
  return out;
}

}  // namespace fairing
