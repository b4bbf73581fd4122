// SPDX-License-Identifier: GPL-3.0-or-later
// The matrix of a level's rows against passes over them.
#include "curvature/normal_matrix.h"

#include <gtest/gtest.h>

#include <cmath>

#include "meshes.h"
#include "random.h"

namespace fairing::test {
namespace {

// Rows of random numbers, as far as a run has any.
void fill(RingJacobian& rows) {
  const GridLevel& lattice = rows.grid();
  std::mt19937 random(5);
  UniformReal<float> number(-1, 1);
  const auto fill_run = [&](const RowRun<float>& run) {
    for (std::size_t k = 0; k < 3 * std::size_t(run.slots) * run.count; ++k)
      run.coefficient[k] = number(random);
  };
  for_each_run(lattice, [&](const auto& run) { fill_run(rows.of(run)); });
}

Unknowns some_unknowns(const ControlMesh& mesh) {
  Unknowns u;
  u.any_vertex = true;
  for (Index v = 0; v < mesh.vertex_count(); ++v) u.vertex.push_back(v % 2);
  for (std::size_t e = 0; e < mesh.edges.size(); ++e) u.edge.push_back(e % 5 != 0);
  return u;
}

TEST(NormalMatrix, DoesWhatThePassesDo) {
  for (const auto& control : {octahedron(), cube(), dodecahedron()})
    for (int level = 1; level <= 3; ++level) {
      const ControlMesh mesh = make_control_mesh(control.view(), {});
      const GridLevel lattice(mesh, level);
      RingJacobian rows(lattice);
      ASSERT_TRUE(NormalMatrix::suits(rows));
      fill(rows);
      const Unknowns unknowns = some_unknowns(mesh);
      Workers workers(2);
      ElementSlots<float, 1> exchange;
      std::mt19937 random(9);
      Normal<float> normal;
      Array<float> x(lattice.size()), expected(x.size()), y(x.size());
      for (float& number : x) number = normal(random);
      // what is no unknown is zero in every vector of the solver
      apply_square(rows, unknowns, workers, exchange, x.data(), expected.data());
      for (std::size_t i = 0; i < x.size(); ++i)
        if (expected[i] == 0) x[i] = 0;
      apply_square(rows, unknowns, workers, exchange, x.data(), expected.data());
      NormalMatrix square(rows, unknowns);
      square.update(rows, workers);
      square.apply(x.data(), workers, y.data());
      float largest = 0;
      for (const float number : expected) largest = std::max(largest, std::abs(number));
      for (std::size_t i = 0; i < x.size(); ++i)
        EXPECT_NEAR(y[i], expected[i], 1e-5f * largest) << i;
    }
}

TEST(NormalMatrix, HasTheConnectionBetween) {
  for (const auto& control : {octahedron(), cube(), dodecahedron()})
    for (int level = 1; level <= 3; ++level) {
      const ControlMesh mesh = make_control_mesh(control.view(), {});
      const GridLevel lattice(mesh, level);
      RingJacobian rows(lattice);
      Connection connection(lattice);
      fill(rows);
      fill(connection.weights());
      const Unknowns unknowns = some_unknowns(mesh);
      Workers workers(2);
      ElementSlots<float, 1> exchange;
      std::mt19937 random(9);
      Normal<float> normal;
      const std::size_t points = lattice.size();
      Array<float> x(points), expected(points), y(points), moment(3 * points), turned(3 * points);
      const auto pass = [&] {
        visit_moments(rows, workers, x.data(), [&](const fairing::Run& run, const float* lanes) {
          for (std::size_t i = 0; i < run.count; ++i)
            for (std::size_t c = 0; c < 3; ++c)
              moment[3 * (run.first + i) + c] = lanes[c * run.count + i];
        });
        connection.apply(0.25, workers, moment.data(), turned.data());
        apply_transposed(rows, unknowns, workers, exchange, turned.data(), expected.data());
      };
      for (float& number : x) number = normal(random);
      pass();
      for (std::size_t i = 0; i < points; ++i)
        if (expected[i] == 0) x[i] = 0;
      pass();
      NormalMatrix square(rows, unknowns, NormalMatrix::Middle::connection);
      square.update(rows, workers, nullptr, {&connection, 0.25f});
      square.apply(x.data(), workers, y.data());
      float largest = 0;
      for (const float number : expected) largest = std::max(largest, std::abs(number));
      for (std::size_t i = 0; i < points; ++i) EXPECT_NEAR(y[i], expected[i], 1e-5f * largest) << i;
    }
}

TEST(NormalMatrix, IsNotForLargeRingsNorLargeFaces) {
  const ControlMesh mesh = make_control_mesh(octahedron().view(), {});
  const GridLevel fine(mesh, 5);
  EXPECT_FALSE(NormalMatrix::suits(RingJacobian(fine)));
  const ControlMesh spokes = make_control_mesh(fan(400).view(), {});
  const GridLevel coarse(spokes, 1);
  EXPECT_FALSE(NormalMatrix::suits(RingJacobian(coarse)));
}

}  // namespace
}  // namespace fairing::test
