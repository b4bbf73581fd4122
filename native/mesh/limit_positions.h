// SPDX-License-Identifier: GPL-3.0-or-later
// Where Catmull-Clark subdivision takes each vertex of a mesh: its limit position, linear in the
// positions of the faces around it [Halstead, Kass, DeRose 1993, §3]. Creases, borders and corners
// as [DeRose, Kass, Truong 1998, §3] have them, semi-sharp ones too; other polygons than quads by one
// subdivision step first.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "mesh/control_mesh.h"
#include "mesh/sharpness.h"
#include "parallel/memory.h"

namespace fairing {

class LimitPositions {
 public:
  LimitPositions() = default;
  // `control` is made of `mesh`. What stays where it is: what the rules keep, and what is not inside
  // the region.
  LimitPositions(const PolygonMesh& mesh, const ControlMesh& control, const SharpRules& rules);

  // `cage`: 3 numbers a vertex of the mesh.
  std::vector<double> of(std::span<const double> cage) const;

  // What is kept, at the most.
  static std::size_t bytes(const PolygonMesh& mesh);

 private:
  Array<Index> corners_, offsets_;  // of the polygons
  // Vertex v moves by the sum over k of weight[k] * (target(k) - v), k from first_[v] to
  // first_[v + 1]; a target is a vertex u as u, the mean of face f's corners as -1 - f.
  Array<std::size_t> first_;
  Array<Index> target_;
  Array<double> weight_;
};

}  // namespace fairing
