// SPDX-License-Identifier: GPL-3.0-or-later
// The second fundamental form M of a surface at one of its points, from the point's one-ring in space alone:
// what total curvature, the integral of k1^2 + k2^2, is measured with and minimized by.
//
// On a mesh inscribed in a sphere of radius R, M is exactly -I/R for any valence and any shape of triangles:
// chart radii are edge lengths, the normal is exact there, and so the heights n . (p_j - p_i) = -|p_j -
// p_i|^2 / 2R are a quadratic of the chart. The trace comes from the cotangent Laplacian over the
// circumcentric area, which takes the same squares to the same value and, unlike least squares, is symmetric:
// so these meshes are critical points of the discrete energy as well.
//
// The trace-free part is a least-squares fit with weights 1 / distance^2, 0.3 times that for a quad's far corner: where
// spacing is uneven, as beside control vertices, the far neighbours would otherwise decide (on the Clifford torus this
// takes the error to a third).
//
// A quad counts as the mean of its two triangulations; its far corner is a neighbour like any other, at its
// own distance and between its own angles (rather than where a flattened quad would have it): so it stays
// exact too.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "chart/chart.h"

namespace fairing {

constexpr double least_area_share = 0.1;  // of the barycentric area
constexpr double ring_thinnest = 1e-24;   // squared sine below which a triangle has no cotangents
constexpr double far_corner_weight =
    0.3;                                 // in the fit, beside what its distance makes of a quad's far corner
constexpr double ring_nearest = 1e-200;  // squared distance below which a neighbour is the point itself

// The ring of a point p_i, counter-clockwise; a closed one has three neighbours or more.
struct SurfaceRing {
  std::span<const Vec3> offset;       // p_j - p_i
  std::span<const std::uint8_t> far;  // 1: p_j is the corner across a quad, between the quad's other two
  bool closed = true;                 // else it runs from one boundary edge to the other
  std::span<const float> lift{};      // of the neighbours (area_lift); empty: all zero
  float own_lift = 0;
};

// The chart of a ring: the exponential map of the surface itself. Edge lengths are radii; the angles between
// neighbours are summed from the first one, which lies on the u axis, and scaled to a full turn.
struct SurfaceChart {
  std::vector<Vec2> ring;
  std::vector<double> height;     // n . (p_j - p_i)
  std::vector<double> weight;     // of the neighbours in the fit of the trace-free part
  std::vector<double> rest;       // the heights without the trace's part
  std::vector<double> cotangent;  // half the cotangents across the edge to p_j, added up
};

struct PointCurvature {
  // Of unit length; weighted as by Max (1999), so exact on spheres.
  Vec3 normal = Vec3::Zero();
  // M_uu + M_vv = k1 + k2: negative where the surface bends away from its normal.
  double trace = 0;
  // ((M_uu - M_vv)/sqrt 2, sqrt 2 M_uv) in the chart.
  std::array<double, 2> trace_free{};
  // The point's share: circumcentric, but at least a tenth of the barycentric one.
  double area = 0;

  // k1^2 + k2^2
  double density() const {
    return 0.5 * trace * trace + trace_free[0] * trace_free[0] + trace_free[1] * trace_free[1];
  }
};

// Obtuse triangles around an irregular vertex can make the circumcentric area small or negative. Any symmetric weights
// would do in place of the cotangents, with the area that belongs to them: so the negative ones, of edges to a point
// whose area is too small, are lifted towards zero. The share is the greater one of the edge's two ends (area_lift), so
// that the weights stay symmetric.
//
// `chart` is written, and takes no new memory once it has held a ring of that size. Should the area still be below the
// floor, the fit's trace stands for the share that it lacks: the sphere stays exact. An open ring has the barycentric
// area, and all of M from the fit. A ring that has a neighbour at the point itself, or no normal, has no curvature and
// no area.
PointCurvature point_curvature(const SurfaceRing& ring, SurfaceChart& chart);

// The share, 0 to 1, by which negative cotangents around a closed ring have to rise for its area to reach the floor.
float area_lift(const SurfaceRing& ring, SurfaceChart& chart);

}  // namespace fairing
