// SPDX-License-Identifier: GPL-3.0-or-later
// What the tests of levels share: meshes of every kind, and all that a level needs on each of them.
#pragma once

#include <Eigen/Dense>
#include <functional>
#include <map>
#include <numbers>
#include <string>

#include "meshes.h"
#include "multigrid/level_operator.h"
#include "paper/charts.h"
#include "reference_rings.h"
#include "sparse/unknown_points.h"
#include "stencil/stencils.h"

namespace fairing::test {

using Dense = Eigen::MatrixXd;
using Points = Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>;  // a vector of a level
using FloatPoints = Eigen::Matrix<float, Eigen::Dynamic, 3, Eigen::RowMajor>;

constexpr double pi = std::numbers::pi;

ControlMesh control(const OwnedPolygonMesh& mesh, const FeatureOptions& features = {});

// Moves every vertex a little, so that no symmetry hides an error.
OwnedPolygonMesh shaken(OwnedPolygonMesh mesh, double by = 0.15);

// Two apexes of valence k over a ring of vertices of valence 4.
OwnedPolygonMesh bipyramid(int k);
// Quads and triangles side by side: every second quad of a grid cut.
OwnedPolygonMesh mixed_grid(int columns, int rows);

const std::map<std::string, ControlMesh>& all_meshes();

Unknowns all_points(const ControlMesh& mesh);
// No vertex (0), every second vertex without a feature (1), all of these (2).
Unknowns some_points(const ControlMesh& mesh, int choice);

Points random_points(std::size_t size, unsigned seed = 1);
// Zero where the point is known.
Points masked(const GridLevel& grid, const Unknowns& unknowns, Points x);
// With the room that rows may read in packs.
FloatPoints with_room(const Points& x);

// Slots that hold rubbish: nothing may be read that this pass has not written.
template <class T>
ElementSlots<T> poisoned(const GridLevel& grid) {
  ElementSlots<T> slots;
  slots.fit(grid);
  for (Array<T>* part : {&slots.row, &slots.side, &slots.end, &slots.spoke})
    std::fill(part->begin(), part->end(), std::numeric_limits<T>::quiet_NaN());
  return slots;
}

struct Setting {
  const ControlMesh& mesh;
  GridLevel grid;
  const ChartMaker& charts;
  Stencils stencils;
};

using MakeCharts = std::function<std::unique_ptr<ChartMaker>(const ControlMesh&)>;
MakeCharts charts_of(double exponent = centripetal, const PaperOptions& options = {});

// Calls body(setting, workers) for every mesh at every level up to `most_levels`.
void on_all(int most_levels, const std::function<void(const Setting&, Workers&)>& body,
            const MakeCharts& make = charts_of(), double tension = 0);

}  // namespace fairing::test
