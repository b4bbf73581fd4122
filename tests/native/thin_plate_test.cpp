// SPDX-License-Identifier: GPL-3.0-or-later
// The thin plate's K in all its forms against the one that is written down from charts and fits.
#include <gtest/gtest.h>

#include "level_settings.h"
#include "thin_plate/differences.h"
#include "thin_plate/level.h"
#include "thin_plate/operator.h"

namespace fairing::test {
namespace {

// K over all points from charts and fits, with rings found by walking around cells.
Dense reference_stiffness(const Setting& s) {
  const double scale = double(s.grid.n()) * s.grid.n();
  Dense k = Dense::Zero(Eigen::Index(s.grid.size()), Eigen::Index(s.grid.size()));
  const RingWalker walker(cells(s.grid));
  visit_fits(s.grid, walker, s.charts, [&](const ReferenceFit& fit) {
    if (fit.chart.ring.empty()) return;
    ASSERT_EQ(fit.ring.size(), fit.chart.ring.size());
    Dense g = Dense::Zero(3, k.cols());
    for (std::size_t j = 0; j < fit.ring.size(); ++j) {
      const Eigen::Vector3d column = fit.rows.col(Eigen::Index(j)).tail<3>();
      g.col(fit.ring[j].point) += column;
      g.col(fit.centre) -= column;
    }
    // Only the columns of the ring are set; the product below is still fine on these small levels.
    std::vector<Index> points{fit.centre};
    for (const auto& r : fit.ring) points.push_back(r.point);
    std::sort(points.begin(), points.end());
    points.erase(std::unique(points.begin(), points.end()), points.end());
    for (const Index a : points)
      for (const Index b : points) k(a, b) += scale * fit.chart.area * g.col(a).dot(g.col(b));
  });
  return k;
}

Dense assembled(const Setting& s, const Unknowns& unknowns, const VertexWeights& weights = {}) {
  Workers workers(1);
  return Dense(assemble_thin_plate(s.grid, s.stencils, unknowns, weights, workers).matrix);
}

TEST(Assembly, IsTheMatrixOfChartsAndFits) {
  for (const MakeCharts& charts :
       {charts_of(), charts_of(1), charts_of(0), charts_of(centripetal, {.chart_blend = 0.4}),
        charts_of(1, {.chart = ChartKind::tangent})})
    on_all(
        2,
        [](const Setting& s, Workers&) {
          const Dense expected = reference_stiffness(s), actual = assembled(s, all_points(s.mesh));
          EXPECT_LT((actual - expected).norm(), 1e-11 * expected.norm() + 1e-300);
        },
        charts);
}

// With and without a membrane.
void on_all_tensions(int most_levels, const std::function<void(const Setting&, Workers&)>& body) {
  for (const double tension : {0.0, 0.1}) on_all(most_levels, body, charts_of(), tension);
}

TEST(ThinPlate, IsTheAssembledSystemOnItsUnknowns) {
  on_all_tensions(2, [](const Setting& s, Workers& workers) {
    for (int choice = 0; choice < 3; ++choice) {
      const Unknowns unknowns = some_points(s.mesh, choice);
      VertexWeights weights(std::size_t(s.mesh.vertex_count()), 0.0);
      for (std::size_t v = 0; v < weights.size(); v += 3) weights[v] = 0.5 + double(v);
      const AssembledSystem system =
          assemble_thin_plate(s.grid, s.stencils, unknowns, weights, workers);
      const Dense k(system.matrix);
      EXPECT_EQ((k - k.transpose()).norm(), 0);
      const ThinPlateRows<double> rows(s.mesh, s.stencils);
      ElementSlots<double> slots = poisoned<double>(s.grid);
      const Points x = masked(s.grid, unknowns, random_points(s.grid.size()));
      Points y(x.rows(), 3);
      apply_thin_plate(s.grid, rows, unknowns, weights, workers, slots, x.data(), y.data());
      Points small(k.cols(), 3);
      for (std::size_t r = 0; r < system.unknown_points.size(); ++r)
        small.row(Eigen::Index(r)) = x.row(system.unknown_points[r]);
      const Points expected = k * small;
      const Array<float> diagonal =
          thin_plate_diagonal(s.grid, s.stencils, unknowns, workers, slots);
      ASSERT_EQ(diagonal.size(), s.grid.size());
      std::vector<std::uint8_t> known(s.grid.size(), 1);
      for (std::size_t r = 0; r < system.unknown_points.size(); ++r) {
        const Index p = system.unknown_points[r];
        known[std::size_t(p)] = 0;
        EXPECT_LT((y.row(p) - expected.row(Eigen::Index(r))).norm(), 1e-12 * k.norm() * x.norm());
        const double weight = std::size_t(p) < weights.size() ? weights[std::size_t(p)] : 0.0,
                     entry = k(Eigen::Index(r), Eigen::Index(r)) - weight;
        EXPECT_NEAR(diagonal[std::size_t(p)], entry, 1e-6 * std::max(entry, 1e-6)) << p;
      }
      for (std::size_t p = 0; p < known.size(); ++p)
        if (known[p]) {
          EXPECT_EQ(y.row(Eigen::Index(p)).norm(), 0);
          EXPECT_EQ(diagonal[p], 0.0f);
        }
    }
  });
}

Unknowns inside_region(const ControlMesh& mesh, Unknowns u) {
  for (std::size_t v = 0; v < u.vertex.size(); ++v)
    if (mesh.vertex_part(Index(v)) != RegionPart::inside) u.vertex[v] = 0;
  for (std::size_t e = 0; e < u.edge.size(); ++e)
    if (mesh.edge_part(Index(e)) != RegionPart::inside) u.edge[e] = 0;
  for (const RegionPart place : mesh.region.face) u.face.push_back(place == RegionPart::inside);
  return u;
}

// K in rows, weights of control vertices and the diagonal included, against the assembled system.
void expect_rows_of(const Setting& s, const Unknowns& unknowns, Workers& workers) {
  ThinPlateShared shared(s.mesh, s.stencils, unknowns, workers);
  ThinPlateLevel level(shared, s.grid, {});
  VertexWeights weights(std::size_t(s.mesh.vertex_count()), 0.0);
  for (const bool weighted : {true, false}) {
    for (std::size_t v = 0; v < weights.size(); v += 2)
      weights[v] = weighted ? 0.5 + double(v) : 0.0;
    level.set_weights(weights);
    const AssembledSystem system =
        assemble_thin_plate(s.grid, s.stencils, unknowns, weights, workers);
    const Dense k(system.matrix);
    const Points x = masked(s.grid, unknowns, random_points(s.grid.size()));
    Points small(k.cols(), 3), expected = Points::Zero(x.rows(), 3);
    for (Eigen::Index r = 0; r < k.cols(); ++r)
      small.row(r) = x.row(system.unknown_points[std::size_t(r)]);
    small = k * small;
    Array<float> diagonal(s.grid.size(), 1.0f);
    for (Eigen::Index r = 0; r < k.cols(); ++r) {
      const Index p = system.unknown_points[std::size_t(r)];
      expected.row(p) = small.row(r);
      if (k(r, r) > 0) diagonal[std::size_t(p)] = float(1 / k(r, r));
    }
    const FloatPoints xf = with_room(x);
    FloatPoints product = FloatPoints::Constant(x.rows(), 3, 1e30f);
    level.apply(xf.data(), product.data());
    EXPECT_LT((product.cast<double>() - expected).norm(), 1e-6 * k.norm() * x.norm() + 1e-300);
    const Array<float>& inverse = level.inverse_diagonal();
    for (std::size_t p = 0; p < diagonal.size(); ++p)
      EXPECT_NEAR(inverse[p], diagonal[p], 1e-5 * diagonal[p]);
  }
}

TEST(Rows, AreTheAssembledSystem) {
  on_all_tensions(3, [](const Setting& s, Workers& workers) {
    for (int choice = 0; choice < 3; ++choice)
      expect_rows_of(s, some_points(s.mesh, choice), workers);
  });
}

TEST(Rows, AreTheAssembledSystemBesideJoints) {
  Workers workers(1);
  for (const RegionContinuity joint :
       {RegionContinuity::position, RegionContinuity::tangent, RegionContinuity::curvature})
    for (const OwnedPolygonMesh& owned :
         {shaken(grid(4, 3)), shaken(mixed_grid(4, 3)), shaken(torus(6, 5))}) {
      FeatureOptions features;
      features.region = {true, {0, 1, 2, 5}, joint};
      const ControlMesh mesh = control(owned, features);
      for (int level = 1; level <= 3; ++level) {
        SCOPED_TRACE(int(joint) * 10 + level);
        const ChartMaker charts(mesh);
        const Setting s{mesh, GridLevel(mesh, level), charts, make_stencils(mesh, charts, workers)};
        expect_rows_of(s, inside_region(mesh, some_points(mesh, 1)), workers);
      }
    }
}

}  // namespace
}  // namespace fairing::test
