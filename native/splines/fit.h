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
  std::vector<Index> face;                   // the control face of each patch, triangles first
  std::vector<std::vector<LoopEdge>> loops;  // of each patch, counter-clockwise
  std::vector<double> residual, turned;      // of each patch
  std::vector<double>
      angles;  // angles_an_edge a smooth edge, evenly along it; NaN in tips and else
  // The sharpest turn of the lattice, by control faces, and whether patches there fold.
  std::vector<double> lattice_turn;
  double size = 0;
};

// Throws FairingError: bad_shape, bad_option, index_out_of_range, cancelled.
SplineSurface fit_splines(const RefinedSurface& surface, const SplineOptions& options,
                          Monitor& monitor);

}  // namespace fairing
