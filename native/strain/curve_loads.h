// SPDX-License-Identifier: GPL-3.0-or-later
// Loads on the control vertices of feature curves: the fourth derivative of the curve, by divided
// differences of five consecutive vertices. It is zero where a batten through the vertices carries
// no load; but a batten's ends are straight, and those of a curve need not be.
#pragma once

#include <span>
#include <vector>

#include "mesh/control_mesh.h"
#include "strain/ease_system.h"

namespace fairing {

class CurveLoads {
 public:
  // For the curves that are smoothed. `positions` of the control vertices give chord lengths, to
  // the power `exponent`, and the corners of the curves.
  CurveLoads(const ControlMesh& mesh, std::span<const Vec3> positions, double exponent);

  // All control vertices on curves except ends and corners, curve by curve, each once.
  const std::vector<Index>& vertices() const { return vertices_; }
  // Those of them that are in the middle of five. A vertex next to an end is in one or two loads
  // only, so the scatter of other vertices would be attributed to it.
  const std::vector<Index>& middles() const { return middles_; }
  // Square roots of the parameter length that belongs to each vertex; the lengths have mean one.
  const std::vector<double>& roots() const { return roots_; }
  // One row for five consecutive vertices, times the root of the middle one's length; one column
  // for each control vertex of the mesh.
  const LoadMatrix& differences() const { return differences_; }

 private:
  std::vector<Index> vertices_, middles_;
  std::vector<double> roots_;
  LoadMatrix differences_;
};

// Points as rows.
Columns columns_of(std::span<const Vec3> points);

}  // namespace fairing
