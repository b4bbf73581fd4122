// SPDX-License-Identifier: GPL-3.0-or-later
// Turns from cell to cell, of a surface that is bent along a known line.
#include "grid/turns.h"

#include <gtest/gtest.h>

#include <numbers>

#include "meshes.h"
#include "polyhedron.h"

namespace fairing::test {
namespace {

constexpr double bend = std::numbers::pi / 6;

// A flat sheet of unit squares that rises beyond x = line.
void expect_turns(const OwnedPolygonMesh& control, double line, bool creases) {
  ControlMesh mesh = make_control_mesh(control.view(), {});
  if (creases) mesh.feature_edge.assign(mesh.edges.size(), 1);
  const GridLevel grid(mesh, 2);
  Workers workers(2);
  std::vector<double> x(3 * grid.size());
  refine_linearly(grid, mesh.positions, x.data());
  for (std::size_t p = 0; p < grid.size(); ++p)
    x[3 * p + 2] = std::tan(bend) * std::max(x[3 * p] - line, 0.0);
  const std::vector<double> turns = sharpest_turns(grid, workers, x.data());
  for (std::size_t f = 0; f < turns.size(); ++f) {
    int on = 0, before = 0, beyond = 0;
    for (int k = 0; k < mesh.faces[f].size; ++k) {
      const double at = mesh.positions[std::size_t(mesh.faces[f].vertex[std::size_t(k)])].x();
      on += at == line;
      before += at < line;
      beyond += at > line;
    }
    const bool is_bent = (before > 0 && beyond > 0) || (on == 2 && !creases);
    EXPECT_NEAR(turns[f], is_bent ? bend : 0, 1e-12) << f << " " << line << " " << creases;
  }
}

TEST(Turns, AreThoseOfBendsInFacesAndOnEdgesThatAreNoCreases) {
  for (const OwnedPolygonMesh& control : {grid(3, 3), triangulated(grid(3, 3))})
    for (const double line : {1.0, 1.5})
      for (const bool creases : {false, true}) expect_turns(control, line, creases);
}

}  // namespace
}  // namespace fairing::test
