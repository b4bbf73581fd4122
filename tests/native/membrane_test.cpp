// SPDX-License-Identifier: GPL-3.0-or-later
// Tension's L against linear elements on the cells of the flat control faces; its other forms are
// compared with the plate's.
#include <gtest/gtest.h>

#include <cmath>

#include "grid/linear.h"
#include "level_settings.h"
#include "stencil/metric.h"
#include "thin_plate/level.h"

namespace fairing::test {
namespace {

const MembraneOptions taut{0.1};

double metric_edge(const ControlMesh& mesh, const std::vector<FlatFace>& flat) {
  double sum = 0;
  for (std::size_t e = 0; e < mesh.edges.size(); ++e) sum += edge_length(mesh, flat, Index(e));
  return sum / double(mesh.edges.size());
}

// Adds factor * |grad|^2 of the flat triangle with these corners, as a quadratic form.
void add_triangle(const std::array<Index, 3>& point, const std::array<Eigen::Vector2d, 3>& at,
                  double factor, Dense& l) {
  const Eigen::Vector2d u = at[1] - at[0], v = at[2] - at[0];
  const double twice = u.x() * v.y() - u.y() * v.x();
  Eigen::Matrix<double, 2, 3> gradient;
  for (int c = 0; c < 3; ++c) {
    const Eigen::Vector2d across = at[std::size_t(c + 2) % 3] - at[std::size_t(c + 1) % 3];
    gradient.col(c) = Eigen::Vector2d(-across.y(), across.x()) / twice;
  }
  const Eigen::Matrix3d form = 0.5 * std::abs(twice) * factor * gradient.transpose() * gradient;
  for (std::size_t a = 0; a < 3; ++a)
    for (std::size_t b = 0; b < 3; ++b)
      l(point[a], point[b]) += form(Eigen::Index(a), Eigen::Index(b));
}

// L of all points, cell by cell: a flat triangle's cells are its own shape, a quad's parallelograms
// are cut either way.
Dense reference(const GridLevel& grid, double exponent) {
  const ControlMesh& mesh = grid.mesh();
  const std::vector<FlatFace> flat = flatten(mesh, exponent);
  const double length = metric_edge(mesh, flat), factor = 0.5 * taut.strength() / (length * length);
  Dense l = Dense::Zero(Eigen::Index(grid.size()), Eigen::Index(grid.size()));
  for (Index f = 0; f < Index(mesh.faces.size()); ++f) {
    const bool quad = mesh.faces[std::size_t(f)].quad();
    const FlatFace& shape = flat[std::size_t(f)];
    const Eigen::Vector2d i_step(shape.length[0], 0),
        j_step = shape.length[quad ? 3 : 2] *
                 Eigen::Vector2d(std::cos(shape.angle[0]), std::sin(shape.angle[0]));
    const auto add = [&](std::array<GridPoint, 3> corner, double share) {
      std::array<Index, 3> point;
      std::array<Eigen::Vector2d, 3> at;
      for (std::size_t c = 0; c < 3; ++c) {
        point[c] = grid.face_point(f, corner[c]);
        at[c] = corner[c].i * i_step + corner[c].j * j_step;
      }
      add_triangle(point, at, share * factor, l);
    };
    const int n = grid.n();
    for (int j = 0; j < n; ++j)
      for (int i = 0; i < (quad ? n : n - j); ++i) {
        const GridPoint a{i, j}, b{i + 1, j}, c{i + 1, j + 1}, d{i, j + 1};
        if (quad) {
          for (const auto& t : {std::array{a, b, c}, {a, c, d}, {a, b, d}, {b, c, d}}) add(t, 0.5);
        } else {
          add({a, b, d}, 1);
          if (i + j + 2 <= n) add({b, c, d}, 1);
        }
      }
  }
  return l;
}

Dense assembled(const Setting& s, const Stencils& stencils) {
  Workers workers(1);
  return Dense(assemble_thin_plate(s.grid, stencils, all_points(s.mesh), {}, workers).matrix);
}

TEST(Membrane, IsThatOfLinearElements) {
  for (const double exponent : {0.0, 0.5, 1.0})
    on_all(
        2,
        [&](const Setting& s, Workers& workers) {
          const Stencils plain = make_stencils(s.mesh, s.charts, workers);
          const Dense with = assembled(s, s.stencils), l = with - assembled(s, plain);
          EXPECT_LT((l - reference(s.grid, exponent)).norm(), 1e-11 * with.norm());
          EXPECT_LT((l * Dense::Ones(l.cols(), 1)).norm(), 1e-12 * with.norm());
        },
        charts_of(exponent), taut.tension);
}

TEST(Membrane, HasItsOwnEnergy) {
  const auto body = [](const Setting& s, Workers& workers) {
    const Stencils plain = make_stencils(s.mesh, s.charts, workers);
    const Points free = random_points(s.grid.size(), 5);
    const double energy = membrane_energy(s.grid, s.stencils, workers, free.data()),
                 form = (free.transpose() * reference(s.grid, 0.5) * free).trace();
    EXPECT_NEAR(energy, form, 1e-12 * form);
    EXPECT_EQ(membrane_energy(s.grid, plain, workers, free.data()), 0);
    EXPECT_EQ(thin_plate_energy(s.grid, s.stencils, workers, free.data()),
              thin_plate_energy(s.grid, plain, workers, free.data()));
  };
  on_all(3, body, charts_of(), taut.tension);
}

// Only the faces that are faired stretch a membrane, and their edges give its unit.
TEST(Membrane, EndsAtARegionsJoint) {
  Workers workers(1);
  for (const RegionContinuity joint :
       {RegionContinuity::position, RegionContinuity::tangent, RegionContinuity::curvature}) {
    FeatureOptions features;
    features.region = {true, {0, 1, 2, 5}, joint};
    const ControlMesh mesh = control(shaken(mixed_grid(4, 3)), features);
    const Stencils stencils = make_stencils(mesh, ChartMaker(mesh), workers, taut);
    const GridLevel grid(mesh, 2);
    Points x = random_points(grid.size());
    const double before = membrane_energy(grid, stencils, workers, x.data());
    EXPECT_GT(before, 0);
    for (Index f = 0; f < Index(mesh.faces.size()); ++f)
      if (mesh.face_part(f) == RegionPart::outside)
        for (int j = 1; j < grid.n() - 2; ++j) x.row(grid.face_point(f, 1, j)).setRandom();
    EXPECT_EQ(membrane_energy(grid, stencils, workers, x.data()), before);

    Unknowns unknowns = some_points(mesh, 1);
    for (std::size_t v = 0; v < unknowns.vertex.size(); ++v)
      unknowns.vertex[v] &= mesh.vertex_part(Index(v)) == RegionPart::inside;
    for (std::size_t e = 0; e < unknowns.edge.size(); ++e)
      unknowns.edge[e] &= mesh.edge_part(Index(e)) == RegionPart::inside;
    for (const RegionPart part : mesh.region.face)
      unknowns.face.push_back(part == RegionPart::inside);
    const Dense all(assemble_thin_plate(grid, stencils, all_points(mesh), {}, workers).matrix);
    ElementSlots<double> slots = poisoned<double>(grid);
    Points y(x.rows(), 3);
    apply_thin_plate(grid, ThinPlateRows<double>(mesh, stencils), unknowns, {}, workers, slots,
                     x.data(), y.data());
    const Points expected = masked(grid, unknowns, all * x);
    EXPECT_LT((y - expected).norm(), 1e-12 * all.norm() * x.norm());
  }
}

}  // namespace
}  // namespace fairing::test
