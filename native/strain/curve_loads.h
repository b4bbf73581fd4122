// SPDX-License-Identifier: GPL-3.0-or-later
// Loads on the control vertices of feature curves: the fourth derivative of the curve, by divided
// differences of five vertices in a row. Where a batten through the vertices has no load, neither
// have they; but battens end straight, and curves of a shape need not.
#pragma once

#include <span>
#include <vector>

#include "mesh/control_mesh.h"
#include "strain/ease.h"

namespace fairing {

class CurveLoads {
 public:
  // Of the curves that are smoothed. `positions` of the control vertices give chord lengths, to the
  // power `exponent`, and say where curves have corners.
  CurveLoads(const ControlMesh& mesh, std::span<const Vec3> positions, double exponent);

  // All on curves but ends and corners, curve by curve; none of them twice.
  const std::vector<Index>& vertices() const { return vertices_; }
  // Those of them that are in the middle of five: what is next to an end takes part in one load or
  // two, and scatter of the others would be read as its own.
  const std::vector<Index>& middles() const { return middles_; }
  // Square roots of the length that is each one's, in the parameter, the mean of lengths one.
  const std::vector<double>& roots() const { return roots_; }
  // One row for each five vertices in a row, times the root of the middle one's length; one column a
  // control vertex of the mesh.
  const LoadMatrix& differences() const { return differences_; }

 private:
  std::vector<Index> vertices_, middles_;
  std::vector<double> roots_;
  LoadMatrix differences_;
};

// Points as rows.
Columns columns_of(std::span<const Vec3> points);

}  // namespace fairing
