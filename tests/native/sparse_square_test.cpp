// SPDX-License-Identifier: GPL-3.0-or-later
// The matrix of a level's rows against passes over them.
#include "energy/sparse_square.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "energy/ring_passes.h"
#include "meshes.h"

namespace fairing::test {
namespace {

// Rows of random numbers, as far as a run has any.
void fill(RingRows& rows) {
  const Lattice& lattice = rows.lattice();
  std::mt19937 random(5);
  std::uniform_real_distribution<float> number(-1, 1);
  const auto fill_run = [&](const RowRun<float>& run) {
    for (std::size_t k = 0; k < 3 * std::size_t(run.slots) * run.count; ++k)
      run.coefficient[k] = number(random);
  };
  for (Index v = 0; v < lattice.mesh().vertex_count(); ++v) fill_run(rows.vertex(v));
  for (Index e = 0; e < Index(lattice.mesh().edges.size()); ++e) fill_run(rows.edge(e));
  for (Index f = 0; f < Index(lattice.mesh().faces.size()); ++f)
    for (int j = 1; j < lattice.n(); ++j)
      if (const RowRun<float> run = rows.face(f, j); run.count > 0) fill_run(run);
}

Unknowns some_unknowns(const ControlMesh& mesh) {
  Unknowns u;
  u.any_vertex = true;
  for (Index v = 0; v < mesh.vertex_count(); ++v) u.vertex.push_back(v % 2);
  for (std::size_t e = 0; e < mesh.edges.size(); ++e) u.edge.push_back(e % 5 != 0);
  return u;
}

TEST(SparseSquare, DoesWhatThePassesDo) {
  for (const auto& control : {octahedron(), cube(), dodecahedron()})
    for (int level = 1; level <= 3; ++level) {
      const ControlMesh mesh = make_control_mesh(control.view(), {});
      const Lattice lattice(mesh, level);
      RingRows rows(lattice);
      ASSERT_TRUE(SparseSquare::suits(rows));
      fill(rows);
      const Unknowns unknowns = some_unknowns(mesh);
      Workers workers(2);
      Exchange<float, 1> exchange;
      std::mt19937 random(9);
      std::normal_distribution<float> normal;
      Array<float> x(lattice.size()), expected(x.size()), y(x.size());
      for (float& number : x) number = normal(random);
      // what is no unknown is zero in every vector of the solver
      apply_square(rows, unknowns, workers, exchange, x.data(), expected.data());
      for (std::size_t i = 0; i < x.size(); ++i)
        if (expected[i] == 0) x[i] = 0;
      apply_square(rows, unknowns, workers, exchange, x.data(), expected.data());
      SparseSquare square(rows, unknowns);
      square.update(rows, workers);
      square.apply(x.data(), workers, y.data());
      float largest = 0;
      for (const float number : expected) largest = std::max(largest, std::abs(number));
      for (std::size_t i = 0; i < x.size(); ++i) EXPECT_NEAR(y[i], expected[i], 1e-5f * largest) << i;
    }
}

TEST(SparseSquare, IsNotForLargeRingsNorLargeFaces) {
  const ControlMesh mesh = make_control_mesh(octahedron().view(), {});
  const Lattice fine(mesh, 5);
  EXPECT_FALSE(SparseSquare::suits(RingRows(fine)));
  const ControlMesh spokes = make_control_mesh(fan(400).view(), {});
  const Lattice coarse(spokes, 1);
  EXPECT_FALSE(SparseSquare::suits(RingRows(coarse)));
}

}  // namespace
}  // namespace fairing::test
