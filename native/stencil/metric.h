// SPDX-License-Identifier: GPL-3.0-or-later
// The control metric: control edge lengths raised to the metric exponent b, and every face
// flattened with these. Lengths are in (mesh units)^b, angles in radians.
#pragma once

#include <array>
#include <vector>

#include "mesh/control_mesh.h"

namespace fairing {

// A flat face: a triangle, or the parallelogram that represents a quad.
struct FlatFace {
  std::array<double, 4> length;  // of side s
  std::array<double, 4> angle;   // at corner s
  double area;                   // of the triangle, or of the parallelogram
};

// exponent in [0, 1]: 1 is Kobbelt's metric, 0 makes triangles equilateral and quads square, 1/2 is
// to surfaces what centripetal parametrization (Lee 1989) is to curves. The triangle inequality
// holds for any exponent up to 1.
//
// A quad becomes the parallelogram of its bilinear map's centre: sides |u|^b and |v|^b, and the
// mean of the angles that fit its two diagonals. Along ridges it counts as shorter, and between flats
// as wide as an arc, except at the exponent 1. Parts of several flat faces keep their shape. Throws
// FairingError(cancelled).
std::vector<FlatFace> flatten(const ControlMesh& mesh, double exponent);

// Length of an edge: the mean over its faces.
double edge_length(const ControlMesh& mesh, const std::vector<FlatFace>& flat, Index edge);

}  // namespace fairing
