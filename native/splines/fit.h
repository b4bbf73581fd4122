// SPDX-License-Identifier: GPL-3.0-or-later
// From a refined surface to bicubic spline patches, C² inside, that share their edges' curves:
// vertices, then edges, then patches, each by small least squares.
#pragma once

#include "parallel/workers.h"
#include "splines/curve_fit.h"
#include "splines/patch_fit.h"
#include "splines/topology.h"

namespace fairing {

struct SplineOptions {
  double tolerance;         // share of the surface's size
  double normal_tolerance;  // radians, between the normals on both sides of an edge
  int threads = 0;
  // Of control faces, triangles first: those of different numbers are in different patches. Empty: no
  // matter.
  std::span<const std::int32_t> groups = {};
};

// An edge of the patches: a curve, or half of one.
struct SplineEdge {
  SplineCurve curve;
  EdgeKind kind;
  std::array<Index, 2> vertex;
  double error;  // of its curve
};

struct LoopEdge {
  Index edge;
  bool forward;
};

constexpr int angles_an_edge = 17;

struct SplineSurface {
  std::vector<Vec3> vertices;
  std::vector<SplineEdge> edges;
  std::vector<SplinePatch> patches;
  std::vector<std::vector<Index>> faces;     // the control faces of each patch
  std::vector<std::vector<LoopEdge>> loops;  // of each patch, counter-clockwise
  std::vector<double> residual, turned;      // of each patch
  // angles_an_edge a smooth edge, the largest near each of so many places evenly along it, between
  // normals; NaN in tips and else. The jump of the curvature across the edge, in the same way.
  std::vector<double> angles, jumps;
  // Of each control face: the farthest that its part of a patch, or a curve beside it, is off, and
  // the sharpest angle at its sides.
  std::vector<double> face_off, face_angle;
  // The sharpest turn of the lattice, by control faces, and whether patches there fold.
  std::vector<double> lattice_turn;
  double size = 0;
};

// Throws FairingError: bad_shape, bad_option, index_out_of_range, cancelled.
SplineSurface fit_splines(const RefinedSurface& surface, const SplineOptions& options,
                          Monitor& monitor);

}  // namespace fairing
