// SPDX-License-Identifier: GPL-3.0-or-later
// The second fundamental form M of a surface at a point, from the point's one-ring in space only.
// Total curvature, the integral of k1^2 + k2^2, is measured and minimized with it. Its derivatives
// by displacements along the normals are the rows of the Gauss-Newton steps.
//
// On a mesh inscribed in a sphere of radius R, M is exactly -I/R for any valence and any shape of
// triangles: chart radii are edge lengths, the normal is exact there, and so the heights n . (p_j -
// p_i) = -|p_j - p_i|^2 / 2R are a quadratic of the chart. The trace comes from the cotangent
// Laplacian over the circumcentric area, which maps the same squares to the same value and, unlike
// least squares, is symmetric: so these meshes are critical points of the discrete energy as well.
//
// The trace-free part is a least-squares fit with weights 1 / distance^2, times 0.3 for the far
// corner of a quad. With uneven spacing, as next to control vertices, the far neighbours would
// otherwise dominate (on the Clifford torus these weights reduce the error to a third).
//
// A quad counts as the mean of its two triangulations; its far corner is a neighbour like any
// other, at its own distance and between its own angles (not where a flattened quad would place
// it), so that it is exact too.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <numbers>
#include <span>
#include <vector>

#include "base/simd.h"
#include "curvature/options.h"
#include "stencil/chart.h"
#include "stencil/fit.h"

namespace fairing {

constexpr double least_area_share = 0.1;  // of the barycentric area
// Additional weight of a quad's far corner in the fit.
constexpr double far_corner_weight = 0.3;
// A neighbour with a smaller squared distance coincides with the point.
constexpr double ring_nearest = 1e-200;
// A neighbour with a larger squared distance is rejected: squares of areas would overflow.
constexpr double ring_farthest = 1e150;

// The ring of a point p_i, counter-clockwise; a closed one has three neighbours or more.
struct SurfaceRing {
  std::span<const Vec3> offset;  // p_j - p_i
  // 1: p_j is a far corner, across a quad, between the quad's other two corners.
  std::span<const std::uint8_t> far;
  bool closed = true;             // otherwise it runs from one boundary edge to the other
  std::span<const float> lift{};  // of the neighbours (area_lift); empty: all zero
  float own_lift = 0;
};

// A neighbour during the computation of a chart, of one point or of a pack of points (ring_fan.h).
template <class N>
struct RingNeighbour {
  struct Vector {
    N x, y, z;
  };
  struct Turn {
    N cosine, sine;
  };

  Vector p;                                   // p_j - p_i
  N square, radius, inverse, inverse_radius;  // its length, squared, and reciprocals
  Turn turn;            // from the previous neighbour; after lay_out(), the direction in the chart
  N angle;              // of that turn
  N cotangent, weight;  // as in SurfaceChart
};

// The chart of a ring: the exponential map of the surface. Radii are edge lengths; the angles
// between neighbours are summed from the first one, on the u axis, and scaled to a full turn.
struct SurfaceChart {
  std::vector<Vec2> ring;
  std::vector<double> height;     // n . (p_j - p_i)
  std::vector<double> weight;     // in the fit of the trace-free part
  std::vector<Vec3> row;          // the fitted Hessian for a one at p_j
  std::vector<double> cotangent;  // half the sum of the cotangents across the edge to p_j
  std::vector<RingNeighbour<double>> neighbour;
};

struct PointCurvature {
  // Unit length; weighted as by Max (1999), so exact on spheres.
  Vec3 normal = Vec3::Zero();
  // M_uu + M_vv = k1 + k2; negative if the surface bends away from its normal.
  double trace = 0;
  // ((M_uu - M_vv)/sqrt 2, sqrt 2 M_uv) in the chart.
  std::array<double, 2> trace_free{};
  // The point's area: circumcentric, but at least a tenth of the barycentric one.
  double area = 0;

  // k1^2 + k2^2
  double density() const {
    return 0.5 * trace * trace + trace_free[0] * trace_free[0] + trace_free[1] * trace_free[1];
  }

  // For a ring that is not finite, or exceeds ring_farthest: no surface has more energy.
  static PointCurvature infinite() {
    PointCurvature out;
    out.area = out.trace = std::numeric_limits<double>::infinity();
    return out;
  }
  // Whether there are rows.
  bool has_rows() const { return area > 0 && area < std::numeric_limits<double>::infinity(); }
};

// The curvature of one ring, with cot_j half the sum of the cotangents across the edge to p_j:
//
//   normal       Max's: the sum of (p_j x p_k) / (|p_j|^2 |p_k|^2) over the ring's triangles
//   area         circumcentric: the sum of cot_j |p_j|^2 / 4
//   trace        n . (sum of cot_j p_j) / area
//   trace-free   least squares of the heights n . p_j, minus the trace's share |p_j|^2 trace / 4
//
// Obtuse triangles make cotangents negative, and the area too small or negative. Any symmetric
// weights can replace the cotangents, with the area that belongs to them. So where an end of an
// edge needs it (area_lift), its negative cotangent is raised by the greater lift of both ends, a
// share of its distance to zero. If the area is still below its floor, the floor is used, and the
// trace of the fit replaces the missing share: spheres stay exact.
//
// An open ring has the barycentric area, and all of M from the fit. A ring with a coincident
// neighbour, or without a normal, has zero curvature and area; one that is not finite has infinite
// ones.
//
// `chart` is overwritten.
PointCurvature point_curvature(const SurfaceRing& ring, SurfaceChart& chart);

// The share of their distance to zero, 0 to 1, by which the negative cotangents around a closed
// ring must rise for its area to reach the floor; 0 for an open ring. `chart` is scratch.
float area_lift(const SurfaceRing& ring, SurfaceChart& chart);

// M and its rows, components ((M_uu + M_vv)/sqrt 2, (M_uu - M_vv)/sqrt 2, sqrt 2 M_uv).
struct ShapeRows {
  PointCurvature point;
  SurfaceChart chart;
  Vec3 shape = Vec3::Zero();  // M
  std::vector<Vec3> row;      // by the displacement of neighbour j
  Vec3 own = Vec3::Zero();    // by the displacement of the point itself
};

// A stored point of a surface (Linearization::shape), the components of M and the root of its area:
// its area, and |M|^2.
inline double area_of(const float* m) { return double(m[3]) * double(m[3]); }
inline double square_of(const float* m) {
  return double(m[0]) * m[0] + double(m[1]) * m[1] + double(m[2]) * m[2];
}

// The term of h itself, in the components of M, from its trace, its trace-free part (a, b) and a^2
// + b^2: with M = t/2 I + F, F^2 = f^2 I it is M^2 = (t^2/4 + f^2) I + t F, or M^2 - t M / 2. N: a
// number or a pack of numbers.
template <class N>
DF_INLINE void own_term(CurvatureEnergy energy, const N& trace, const N& a, const N& b,
                        const N& square, N& sum, N& difference, N& mixed) {
  if (energy == CurvatureEnergy::total_curvature) {
    sum = root_half * square;
    difference = 0.5 * trace * a;
    mixed = 0.5 * trace * b;
  } else {
    sum = root_half * (0.5 * trace * trace + square);
    difference = trace * a;
    mixed = trace * b;
  }
}

// The trace's row is the cotangent Laplacian over the point's area, which is symmetric after
// weighting with the areas; the trace-free rows are those of the least-squares fit. If the area is
// zero, nothing else is set.
void linearize(const SurfaceRing& ring, CurvatureEnergy energy, ShapeRows& out);

// The chart's u axis in space. Charts scale their angles to a full turn, so the neighbours'
// directions in space differ from those in the chart; this axis fits all of them best, and does not
// depend on the neighbour that the chart started from.
Vec3 chart_axis(const Vec3& normal, SurfaceChart& chart);

}  // namespace fairing
