// SPDX-License-Identifier: GPL-3.0-or-later
// Limits of Catmull-Clark subdivision for a whole mesh [Halstead, Kass, DeRose 1993, §3], with
// creases, borders, corners and semi-sharp edges (mesh/sharpness.h). A linear map of the vertices:
// its tables serve all positions of one mesh.
#pragma once

#include <array>
#include <span>
#include <utility>
#include <vector>

#include "mesh/polygon_mesh.h"
#include "mesh/sharpness.h"
#include "parallel/memory.h"

namespace fairing {

class CatmullClark {
 public:
  // `control` is made from `mesh`. `steps`: at least 1. Throws FairingError(cancelled).
  CatmullClark(const PolygonMesh& mesh, const ControlMesh& control, const SharpRules& rules,
               int steps);

  // Polygon f has the corners corners(f) to corners(f + 1).
  Index corners(Index f) const { return first_[f]; }
  Index vertex(Index corner) const { return levels_[0].vertex[corner]; }

  // Number of pieces of each side of the quad at a polygon's corner. That quad has the corner, the
  // middle of the side to the next corner, the middle of the polygon, and the middle of the side
  // from the corner before.
  int pieces() const { return 1 << (levels_.size() - 1); }
  // The point a pieces from that corner towards the next one and b towards the one before.
  Index point(Index polygon, Index corner, int a, int b) const;

  // Limits of all points, 3 numbers each. Near semi-sharp edges that outlast the steps, and where
  // creases end, the error is that of the last step.
  Array<double> limits(std::span<const double> cage) const;
  // Limit positions of the vertices alone, 3 numbers each, exact. Vertices that the rules keep, and
  // those outside the region, stay bit for bit.
  std::vector<double> vertex_limits(std::span<const double> cage) const;

 private:
  // The sharpness rules of a vertex.
  struct Special {
    Index vertex;
    AroundVertex sharp;
    std::vector<Index> spokes;  // the sharp edges, as long as sharp.spokes
  };
  struct Level {
    Index vertices = 0;
    Array<Index> vertex, edge;  // per corner: the vertex there, and the edge to the next corner
    Array<std::array<Index, 2>> ends;  // per edge
    std::vector<std::pair<Index, double>> sharp_edges;
    std::vector<Special> specials;

    std::size_t size() const { return std::size_t(vertices) + ends.size(); }  // without faces
  };

  void set_polygons(const PolygonMesh& mesh, const ControlMesh& control, const SharpRules& rules);
  void refine();
  // From sharp_edges and the sharpness of vertices.
  static void set_specials(Level& level, const std::vector<std::pair<Index, double>>& vertices);
  std::size_t faces(std::size_t level) const {
    return level == 0 ? first_.size() - 1 : levels_[level].vertex.size() / 4;
  }
  // visit(face, first, last) with the face's corners; visit_corners(face, corner, before).
  template <class Visit>
  void for_each_face(std::size_t level, Visit&& visit) const;
  template <class Visit>
  void for_each_corner(std::size_t level, Visit&& visit) const;
  Array<double> step(std::size_t level, std::span<const double> x) const;
  Array<double> to_limit(std::size_t level, std::span<const double> x) const;
  void put_exact_limits(std::span<const double> x, std::vector<double>& limits) const;

  Array<Index> first_;         // of the polygons' corners
  std::vector<Index> stays_;   // vertices outside the region
  std::vector<Level> levels_;  // before each step
};

}  // namespace fairing
