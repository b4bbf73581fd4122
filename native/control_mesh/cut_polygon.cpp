// SPDX-License-Identifier: GPL-3.0-or-later
#include "control_mesh/cut_polygon.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "execution/cancel.h"

namespace fairing {
namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();
constexpr double tie = 1e-6;

struct Diagonal {
  std::size_t i, j;  // i < j
  bool crosses(const Diagonal& d) const {
    return (i < d.i && d.i < j && j < d.j) || (d.i < i && i < d.j && d.j < j);
  }
};

// cost(i, length): the least badness of the part between the diagonal (i, i + length) and the sides from i
// on to i + length. All starts i are tabulated, round the corner too: then the two sides of a diagonal
// together give the cost of the best triangulation that uses it.
class Costs {
 public:
  Costs(const PolygonShape& shape, const std::function<bool(std::size_t, std::size_t)>& allowed)
      : n_(shape.size()), cost_(n_ * n_, infinite) {
    for (std::size_t i = 0; i < n_; ++i) at(i, 1) = 0;
    for (std::size_t length = 2; length < n_; ++length) {
      stop_if_cancelled();
      for (std::size_t i = 0; i < n_; ++i)
        if (length == n_ - 1 || allowed(i, (i + length) % n_)) at(i, length) = best(shape, i, length);
    }
  }

  double whole() const { return cost_[n_ - 1]; }
  double with(const Diagonal& d) const {
    const std::size_t length = d.j - d.i;
    return cost_[d.i * n_ + length] + cost_[d.j * n_ + n_ - length];
  }

 private:
  double& at(std::size_t i, std::size_t length) { return cost_[i * n_ + length]; }

  double best(const PolygonShape& shape, std::size_t i, std::size_t length) {
    double least = infinite;
    for (std::size_t middle = 1; middle < length; ++middle) {
      const std::size_t m = (i + middle) % n_;
      const double parts = at(i, middle) + at(m, length - middle);
      if (parts < least) least = std::min(least, parts + shape.badness(i, m, (i + length) % n_));
    }
    return least;
  }

  std::size_t n_;
  std::vector<double> cost_;
};

std::vector<Diagonal> undisputed(const std::vector<Diagonal>& diagonals) {
  std::vector<Diagonal> kept;
  for (const Diagonal& d : diagonals)
    if (std::none_of(diagonals.begin(), diagonals.end(), [&](const Diagonal& e) { return d.crosses(e); }))
      kept.push_back(d);
  return kept;
}

std::vector<Piece> cut(std::size_t corners, const std::vector<Diagonal>& diagonals) {
  std::vector<Piece> pieces(1, Piece(corners));
  std::iota(pieces[0].begin(), pieces[0].end(), std::size_t(0));
  for (const Diagonal& d : diagonals) {
    // The diagonals do not cross: exactly one piece holds both ends.
    for (Piece& piece : pieces) {
      const auto first = std::find(piece.begin(), piece.end(), d.i),
                 last = std::find(first, piece.end(), d.j);
      if (last == piece.end()) continue;
      const Piece inner(first, last + 1);
      piece.erase(first + 1, last);
      pieces.push_back(inner);
      break;
    }
  }
  return pieces;
}

}  // namespace

std::vector<Piece> cut_polygon(const PolygonShape& shape,
                               const std::function<bool(std::size_t, std::size_t)>& allowed) {
  const std::size_t n = shape.size();
  const Costs costs(shape, allowed);
  std::vector<Diagonal> best;
  if (std::isfinite(costs.whole()))
    for (std::size_t i = 0; i + 2 < n; ++i)
      for (std::size_t j = i + 2; j < n && j - i < n - 1; ++j)
        if (costs.with({i, j}) <= costs.whole() * (1 + tie)) best.push_back({i, j});
  return cut(n, undisputed(best));
}

}  // namespace fairing
