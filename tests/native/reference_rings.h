// SPDX-License-Identifier: GPL-3.0-or-later
// The passes' reference: a level's cells and one-rings written out as lists, found by walking
// around the cells rather than by grid arithmetic.
#pragma once

#include <array>
#include <unordered_map>
#include <vector>

#include "grid/grid_level.h"
#include "stencil/chart.h"
#include "stencil/fit.h"

namespace fairing::test {

using Cell = std::array<Index, 4>;  // counter-clockwise; [3] == -1 for a triangle

std::vector<Cell> cells(const GridLevel& grid);

struct RingNeighbour {
  Index point;
  int cell = -1;  // for the far corner of a quad: the quad; else -1
};

class RingWalker {
 public:
  explicit RingWalker(std::vector<Cell> all);

  // The ring of `centre`, counter-clockwise from its neighbour `first`; an open ring that has an
  // end there goes on at its other end.
  std::vector<RingNeighbour> ring(Index centre, Index first) const;
  const std::vector<Cell>& all() const { return cells_; }

 private:
  struct Step {
    int cell, corner;
  };
  const Step* find(Index from, Index to) const;

  std::vector<Cell> cells_;
  std::unordered_map<std::uint64_t, Step> steps_;  // directed edge -> its cell
};

// Everything that a fit needs: the centre's ring, its chart, and the fit over it.
struct ReferenceFit {
  Index centre;
  std::vector<RingNeighbour> ring;
  Chart chart;
  FitRows rows;
  bool in_face;  // the point lies inside a control face
};

// Calls visit(const ReferenceFit&) for every point of a level, with an empty chart where the point
// carries no fit.
template <class Visit>
void visit_fits(const GridLevel& grid, const RingWalker& walker, const ChartMaker& charts,
                Visit&& visit) {
  const ControlMesh& mesh = grid.mesh();
  const auto go = [&](Index centre, Index first, bool has_fit, bool in_face, auto&& make_chart) {
    ReferenceFit out{centre, walker.ring(centre, first), {}, {}, in_face};
    if (has_fit) {
      out.chart = make_chart();
      out.rows = fit(out.chart);
    }
    visit(out);
  };
  for (Index v = 0; v < mesh.vertex_count(); ++v)
    if (!mesh.ring(v).empty())
      go(v, grid.spoke_point(mesh.ring(v)[0]), !mesh.feature_vertex[std::size_t(v)], false,
         [&] { return charts.vertex(v); });
  for (Index e = 0; e < Index(mesh.edges.size()); ++e)
    for (int k = 1; k < grid.n(); ++k)
      go(grid.edge_point(e, k), grid.edge_point(e, k + 1), !mesh.feature_edge[std::size_t(e)],
         false, [&] { return charts.edge(e); });
  for (Index f = 0; f < Index(mesh.faces.size()); ++f) {
    const int n = grid.n();
    const bool quad = mesh.faces[std::size_t(f)].quad();
    for (int j = 1; j < n; ++j)
      for (int i = 1; i < (quad ? n : n - j); ++i)
        go(grid.face_point(f, i, j), grid.face_point(f, i + 1, j), true, true,
           [&] { return charts.face(f); });
  }
}

}  // namespace fairing::test
