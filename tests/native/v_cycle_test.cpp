// SPDX-License-Identifier: GPL-3.0-or-later
// The V-cycle as a linear map: with the degrees before and after coarser levels exchanged it is its
// transpose.
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <random>
#include <vector>

#include "curvature/level.h"
#include "grid/linear.h"
#include "level_settings.h"
#include "multigrid/v_cycle.h"
#include "transfer/level_transfer.h"

namespace fairing::test {
namespace {

constexpr int finest = 3;

// Total curvature of the round polyhedron, levels 1 to 3, and a cycle over them.
struct Cycle {
  ControlMesh mesh;
  Workers workers{1};
  Stencils stencils;
  CurvatureShared shared;
  std::vector<std::unique_ptr<GridLevel>> grids;
  std::vector<std::unique_ptr<CurvatureLevel>> levels;
  std::vector<std::unique_ptr<QuadraticTransfer<1>>> transfers;
  VCycle cycle{workers};

  explicit Cycle(const OwnedPolygonMesh& control)
      : mesh(make_control_mesh(control.view(), {})),
        stencils(make_stencils(mesh, *charts_of()(mesh), workers)),
        shared{mesh, some_points(mesh, 1), workers} {
    for (int l = 1; l <= finest; ++l) {
      grids.push_back(std::make_unique<GridLevel>(mesh, l));
      const GridLevel& grid = *grids.back();
      levels.push_back(std::make_unique<CurvatureLevel>(shared, grid));
      Array<double> x(3 * grid.size());
      refine_linearly(grid, mesh.positions, x.data());
      for (std::size_t i = 0; i < x.size(); i += 3) {
        Eigen::Map<Vec3> p(x.data() + i);
        p /= std::sqrt(0.3 + p.squaredNorm());
      }
      levels.back()->linearize(x.data(), {});
      if (l > 1)
        transfers.push_back(std::make_unique<QuadraticTransfer<1>>(*grids[grids.size() - 2], grid,
                                                                   stencils, shared.unknowns,
                                                                   workers, shared.float_slots));
      CycleLevel& own = cycle.levels.emplace_back();
      own.op = levels.back().get();
      own.transfer = l > 1 ? transfers.back().get() : nullptr;
      own.largest_eigenvalue = 4;
      own.state.resize(grid.size());
    }
    cycle.coarse = std::make_unique<CoarseSolver>(*levels.front(), workers, 0, true);
  }

  std::size_t size() const { return grids.back()->size(); }

  std::vector<float> run(const std::vector<float>& b, int before, int after) {
    SmootherState& state = cycle.levels.back().state;
    std::copy(b.begin(), b.end(), state.residual.begin());
    cycle.run(cycle.levels.size() - 1, before, after);
    return {state.x.begin(), state.x.begin() + std::ptrdiff_t(b.size())};
  }

  std::vector<float> some(unsigned seed) const {
    std::mt19937 random(seed);
    std::vector<float> out(size());
    for (std::size_t i = 0; i < out.size(); ++i)
      out[i] = levels.back()->diagonal()[i] > 0 ? float(random()) / 4294967296.0f - 0.5f : 0.0f;
    return out;
  }
};

double dot(const std::vector<float>& a, const std::vector<float>& b) {
  double out = 0;
  for (std::size_t i = 0; i < a.size(); ++i) out += double(a[i]) * b[i];
  return out;
}

TEST(VCycle, WithDegreesExchangedIsItsTranspose) {
  for (const auto& control : {octahedron(), cube()}) {
    Cycle c(control);
    const std::vector<float> a = c.some(1), b = c.some(2);
    const std::vector<float> of_a = c.run(a, 5, 1), of_b = c.run(b, 5, 1);
    const double size = std::sqrt(dot(of_a, of_a) * dot(b, b));
    EXPECT_NEAR(dot(of_a, b), dot(a, c.run(b, 1, 5)), 1e-5 * size);
    EXPECT_GT(std::abs(dot(of_a, b) - dot(a, of_b)), 1e-4 * size);  // it is not symmetric
  }
}

}  // namespace
}  // namespace fairing::test
