// SPDX-License-Identifier: GPL-3.0-or-later
// Where Catmull-Clark subdivision takes each vertex of a mesh: its limit position, linear in the
// positions of the faces around it [Halstead, Kass, DeRose 1993, §3]. Creases, borders and corners
// as [DeRose, Kass, Truong 1998, §3] have them, semi-sharp ones too; other polygons than quads by one
// subdivision step first.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "mesh/control_mesh.h"
#include "parallel/memory.h"

namespace fairing {

// For how many subdivision steps a rule stays sharp before it becomes smooth; from `always_sharp` on,
// for ever, as OpenSubdiv has it.
constexpr double always_sharp = 10;

struct Sharpness {
  // Vertex pairs in any order, and the sharpness of each: theirs counts, be they creases or not.
  std::pair<std::vector<std::array<std::int64_t, 2>>, std::vector<double>> edges;
  std::vector<double> vertices;  // one a vertex, or empty; 0: none is given
};

// Throws FairingError(bad_option) for values that are negative or NaN, or not one an edge;
// index_out_of_range for edges of vertices that are not in the mesh.
void check_edge_sharpness(std::int64_t vertices, const Sharpness& sharpness);

class LimitPositions {
 public:
  LimitPositions() = default;
  // Feature edges of `control`, made of `mesh`, are sharp for ever. What stays where it is: `corners`,
  // vertices where a curve turns sharply, those of straight borders, and what is not inside the
  // region. `share`: how far the others go, from 0, not at all, to 1, to their limits.
  LimitPositions(const PolygonMesh& mesh, const ControlMesh& control,
                 std::span<const std::int64_t> corners, const Sharpness& sharpness, double share);

  // `cage`: 3 numbers a vertex of the mesh.
  std::vector<double> of(std::span<const double> cage) const;

  // What is kept, at the most.
  static std::size_t bytes(const PolygonMesh& mesh);

 private:
  double share_ = 0;
  Array<Index> corners_, offsets_;  // of the polygons
  // Vertex v moves by share * sum over k of weight[k] * (target(k) - v), k from first_[v] to
  // first_[v + 1]; a target is a vertex u as u, the mean of face f's corners as -1 - f.
  Array<std::size_t> first_;
  Array<Index> target_;
  Array<double> weight_;
};

}  // namespace fairing
