// SPDX-License-Identifier: GPL-3.0-or-later
// Fits the inside of a patch between given sides.
#pragma once

#include <array>
#include <compare>
#include <limits>
#include <numbers>
#include <vector>

#include "splines/face_surface.h"
#include "splines/spline.h"

namespace fairing {

struct PatchSample {
  Vec3 at, normal;  // of the lattice; zero at the tip of a kink
  double u, v;
  double area;  // weight in the fit, up to a common factor
  int place;    // the face of the patch that contains it
  bool fitted;  // false: only measured
};

struct SideNormal {
  double t;
  Vec3 normal;
  double weight = 1;
};

struct PatchData {
  std::array<SplineCurve, 4> side;  // v = 0, u = 1, v = 1, u = 0; in the direction of u or v
  std::array<std::vector<SideNormal>, 4> normals;
  std::vector<PatchSample> samples;
  std::size_t faces = 1;
  const FaceSurface* surface = nullptr;  // for errors between the samples
  int corner = -1;                       // of the triangle, if the patch is a third of one
  double size;                           // of the model: the weight of an angle against a distance
  // The search ends at these.
  double tolerance, normal_tolerance;
  bool may_fold = false;  // then no time is spent on avoiding it
  bool own = false;       // sides and samples have the lattice's parameters
};

// The errors of a patch in tolerances; if it folds, the angle of the fold, which is worse than any
// other error.
struct Misses {
  bool folds = true;
  double by = std::numeric_limits<double>::infinity();

  auto operator<=>(const Misses&) const = default;
};

struct FittedPatch {
  SplinePatch patch;
  // The largest distance of a sample from the patch, or of the patch from the surface between
  // samples; also for each of its faces.
  double residual = 0;
  std::vector<double> residuals;
  // The largest angle between the normals of patch and lattice, including the sides; radians.
  double turned = 0;
  std::array<double, 4> side_angle{};  // along the sides
  Misses misses;
};

// A patch whose normals deviate by more from the lattice, in radians, is folded; so is a lattice
// whose cells deviate by more from their neighbours.
constexpr double folded = std::numbers::pi / 4;

// The sides are refined exactly to the patch's spans. `last`: no more spans will be tried, so if a
// tolerance is missed, the other ways to fit are tried too.
FittedPatch fit_patch(const PatchData& data, int spans_u, int spans_v, bool last);

// u and v at t of a side, and the patch's point there.
std::array<double, 2> place_on_side(int side, double t);
SurfacePoint on_side(const SplinePatch& patch, int side, double t);

}  // namespace fairing
