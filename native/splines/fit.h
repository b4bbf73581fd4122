// SPDX-License-Identifier: GPL-3.0-or-later
// Fits bicubic spline patches, C² inside, that share their edges' curves, to a refined surface:
// vertices, then edges, then patches, each by small least-squares problems.
#pragma once

#include "parallel/workers.h"
#include "splines/curve_fit.h"
#include "splines/patch_fit.h"
#include "splines/topology.h"

namespace fairing {

struct SplineOptions {
  double tolerance;         // share of the surface's size
  double normal_tolerance;  // radians, between the normals of both sides of an edge
  int threads = 0;
  // Numbers of control faces, triangles first: faces with different numbers are in different
  // patches. Empty: no restriction.
  std::span<const std::int32_t> groups = {};
};

// An edge between patches: a curve, or half of one.
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
  std::vector<std::vector<Index>> faces;     // control faces of each patch
  std::vector<std::vector<LoopEdge>> loops;  // of each patch, counter-clockwise
  std::vector<double> residual, turned;      // by patch
  // For each smooth edge angles_an_edge values: the largest angle between normals near each of as
  // many places, evenly spaced along it; NaN in tips and for other edges. The same for the jump of
  // the curvature across the edge.
  std::vector<double> angles, jumps;
  // For each control face: the largest error of its part of a patch, or of a curve next to it, and
  // the largest angle at its sides.
  std::vector<double> face_off, face_angle;
  // The largest angle of the lattice in each control face, and whether patches fold there.
  std::vector<double> lattice_turn;
  double size = 0;
};

// Throws FairingError: bad_shape, bad_option, index_out_of_range, cancelled.
SplineSurface fit_splines(const RefinedSurface& surface, const SplineOptions& options,
                          Monitor& monitor);

}  // namespace fairing
