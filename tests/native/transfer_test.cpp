// SPDX-License-Identifier: GPL-3.0-or-later
// Prolongation and restriction.
#include <gtest/gtest.h>

#include <map>
#include <utility>
#include <vector>

#include "grid/linear.h"
#include "level_settings.h"
#include "thin_plate/operator.h"
#include "transfer/level_transfer.h"

namespace fairing::test {
namespace {

// P over all points, from the text in transfer/quadratic.h.
Dense reference_prolongation(const Setting& coarse, const GridLevel& fine) {
  const GridLevel& grid = coarse.grid;
  const auto size = Eigen::Index(grid.size());
  Dense p = Dense::Zero(Eigen::Index(fine.size()), size);
  const RingWalker walker(cells(grid));
  // Where the fine points are: over coarse points, half-way along coarse edges, and in the middle
  // of quad cells.
  std::vector<Index> over(grid.size(), -1);
  std::map<std::pair<Index, Index>, Index> along;
  std::vector<Index> middle;
  const int n = grid.n();
  for (Index v = 0; v < grid.mesh().vertex_count(); ++v) over[std::size_t(v)] = v;
  for (Index f = 0; f < Index(grid.mesh().faces.size()); ++f) {
    const bool quad = grid.mesh().faces[std::size_t(f)].quad();
    const auto note = [&](int i, int j, int di, int dj) {
      const int i2 = i + di, j2 = j + dj;
      if (i2 < 0 || j2 < 0 || i2 > n || j2 > n || (!quad && i2 + j2 > n)) return;
      const Index a = grid.face_point(f, i, j), b = grid.face_point(f, i2, j2);
      along[{std::min(a, b), std::max(a, b)}] = fine.face_point(f, i + i2, j + j2);
    };
    for (int j = 0; j <= n; ++j)
      for (int i = 0; i <= (quad ? n : n - j); ++i) {
        over[std::size_t(grid.face_point(f, i, j))] = fine.face_point(f, 2 * i, 2 * j);
        note(i, j, 1, 0);
        note(i, j, 0, 1);
        if (!quad) note(i, j, -1, 1);
      }
  }
  for (Index f = 0; f < Index(grid.mesh().faces.size()); ++f) {
    const bool quad = grid.mesh().faces[std::size_t(f)].quad();
    if (quad) {
      for (int j = 0; j < n; ++j)
        for (int i = 0; i < n; ++i) middle.push_back(fine.face_point(f, 2 * i + 1, 2 * j + 1));
    } else {
      middle.insert(middle.end(), std::size_t(n) * std::size_t(n), -1);  // as cells() lists them
    }
  }
  for (std::size_t c = 0; c < over.size(); ++c)
    if (over[c] >= 0) p(over[c], Eigen::Index(c)) = 1;

  visit_fits(grid, walker, coarse.charts, [&](const ReferenceFit& fit) {
    const auto opposite = [&](std::size_t j) {
      return fit.ring[(j + fit.ring.size() / 2) % fit.ring.size()].point;
    };
    for (std::size_t j = 0; j < fit.ring.size(); ++j) {
      const RingNeighbour& r = fit.ring[j];
      const Index to =
          r.cell >= 0 ? middle.at(std::size_t(r.cell))
                      : along.at({std::min(fit.centre, r.point), std::max(fit.centre, r.point)});
      const double weight = r.cell >= 0 ? 0.25 : 0.5;
      const auto add = [&](Index from, double w) { p(to, from) += weight * w; };
      if (fit.chart.ring.empty()) {
        if (r.cell >= 0) {
          for (const Index corner : walker.all()[std::size_t(r.cell)]) add(corner, 0.25);
        } else {
          add(fit.centre, 0.5);
          add(r.point, 0.5);
        }
      } else if (fit.in_face) {
        add(r.point, 0.375);
        add(fit.centre, 0.75);
        add(opposite(j), -0.125);
      } else {
        const Coefficients at = basis(0.5 * fit.chart.ring[j]);
        add(fit.centre, 1);
        for (std::size_t m = 0; m < fit.ring.size(); ++m) {
          const double w = at.dot(fit.rows.col(Eigen::Index(m)));
          add(fit.ring[m].point, w);
          add(fit.centre, -w);
        }
      }
    }
  });
  return p;
}

TEST(Transfer, ProlongsByTheFitsOfCharts) {
  for (const double exponent : {centripetal, 1.0})
    on_all(
        2,
        [](const Setting& s, Workers& workers) {
          const GridLevel fine(s.mesh, s.grid.level() + 1);
          const Dense p = reference_prolongation(s, fine);
          ElementSlots<double> slots = poisoned<double>(fine);
          const Points x = random_points(s.grid.size());
          Points y = random_points(fine.size(), 2);
          prolong<double>(s.grid, fine, s.stencils, nullptr, workers, slots, x.data(), y.data());
          EXPECT_LT((y - p * x).norm(),
                    2e-7 * p.norm() * x.norm());  // the rows are stored in single precision
        },
        charts_of(exponent));
}

TEST(Transfer, RestrictionIsTheTranspose) {
  on_all(2, [](const Setting& s, Workers& workers) {
    const GridLevel fine(s.mesh, s.grid.level() + 1);
    for (int choice = 0; choice < 3; ++choice) {
      const Unknowns unknowns = some_points(s.mesh, choice);
      ElementSlots<double> slots = poisoned<double>(fine);
      const Points x = masked(s.grid, unknowns, random_points(s.grid.size()));
      const Points y = masked(fine, unknowns, random_points(fine.size(), 2));
      Points px = random_points(fine.size(), 3), py = random_points(s.grid.size(), 4);
      prolong(s.grid, fine, s.stencils, &unknowns, workers, slots, x.data(), px.data());
      restrict_to(s.grid, fine, s.stencils, unknowns, workers, slots, y.data(), py.data());
      EXPECT_EQ((px - masked(fine, unknowns, px)).norm(), 0);
      EXPECT_EQ((py - masked(s.grid, unknowns, py)).norm(), 0);
      for (int a = 0; a < 3; ++a)  // each coordinate is a vector of its own
        EXPECT_NEAR(px.col(a).dot(y.col(a)), x.col(a).dot(py.col(a)),
                    1e-13 * (1 + px.norm() * y.norm()))
            << choice;
    }
  });
}

}  // namespace
}  // namespace fairing::test
