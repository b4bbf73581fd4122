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

// Random rows on one level of a mesh, some of whose points are unknowns.
struct RandomRows {
  ControlMesh mesh;
  GridLevel lattice;
  RingJacobian rows;
  Unknowns unknowns;
  Workers workers{2};
  ElementSlots<float, 1> exchange;

  RandomRows(const OwnedPolygonMesh& control, int level)
      : mesh(make_control_mesh(control.view(), {})),
        lattice(mesh, level),
        rows(lattice),
        unknowns(some_unknowns(mesh)) {
    fill(rows);
  }

  // pass(x, y) does to a random vector what the matrix does.
  template <class Pass>
  void expect_same(const NormalMatrix& matrix, const Pass& pass) {
    std::mt19937 random(9);
    Normal<float> normal;
    Array<float> x(lattice.size()), expected(x.size()), y(x.size());
    for (float& number : x) number = normal(random);
    // what is no unknown is zero in every vector of the solver
    pass(x.data(), expected.data());
    for (std::size_t i = 0; i < x.size(); ++i)
      if (expected[i] == 0) x[i] = 0;
    pass(x.data(), expected.data());
    matrix.apply(x.data(), workers, y.data());
    float largest = 0;
    for (const float number : expected) largest = std::max(largest, std::abs(number));
    for (std::size_t i = 0; i < x.size(); ++i) EXPECT_NEAR(y[i], expected[i], 1e-5f * largest) << i;
  }
};

template <class Body>
void on_all(const Body& body) {
  for (const auto& control : {octahedron(), cube(), dodecahedron()})
    for (int level = 1; level <= 4; ++level) {
      RandomRows setting(control, level);
      body(setting);
    }
}

TEST(NormalMatrix, DoesWhatThePassesDo) {
  on_all([](RandomRows& s) {
    ASSERT_TRUE(NormalMatrix::suits(s.rows));
    NormalMatrix square(s.rows, s.unknowns);
    square.update(s.rows, s.workers);
    s.expect_same(square, [&](const float* x, float* y) {
      apply_square(s.rows, s.unknowns, s.workers, s.exchange, x, y);
    });
  });
}

}  // namespace
}  // namespace fairing::test
