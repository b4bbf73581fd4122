// SPDX-License-Identifier: GPL-3.0-or-later
// A patch: its sides are given, its inside is fitted.
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
  double area;  // that it stands for, to a factor that all share
  int place;    // of the patch's faces, which one it is on
  bool fitted;  // or only measured
};

struct SideNormal {
  double t;
  Vec3 normal;
  double weight = 1;
};

struct PatchData {
  std::array<SplineCurve, 4> side;  // v = 0, u = 1, v = 1, u = 0; along growing u or v
  std::array<std::vector<SideNormal>, 4> normals;
  std::vector<PatchSample> samples;
  std::size_t faces = 1;
  const FaceSurface* surface = nullptr;  // between the samples
  int corner = -1;                       // of which the patch is a third
  double size;                           // of the model: what an angle weighs against a distance
  // What is asked for, and ends the search.
  double tolerance, normal_tolerance;
  bool may_fold = false;  // no time is spent against it
  bool own = false;       // sides and samples are at the lattice's own parameters
};

// How far a patch is off: in tolerances, or where it folds, which is worse than anything else, by the
// angle by which it does.
struct Misses {
  bool folds = true;
  double by = std::numeric_limits<double>::infinity();

  auto operator<=>(const Misses&) const = default;
};

struct FittedPatch {
  SplinePatch patch;
  // The farthest that a sample is from the patch, or the patch from the surface between them; and the
  // same on each of its faces.
  double residual = 0;
  std::vector<double> residuals;
  // The sharpest angle between the normals of patch and lattice, sides included; radians.
  double turned = 0;
  std::array<double, 4> side_angle{};  // the same along the sides
  Misses misses;
};

// A patch that turns by more against the lattice, in radians, folds. So does a lattice from cell to cell.
constexpr double folded = std::numbers::pi / 4;

// The sides are refined to the patch's spans, exactly. `last`: no patch with more spans is going to
// be tried, so that what misses a tolerance is fitted in other ways, too.
FittedPatch fit_patch(const PatchData& data, int spans_u, int spans_v, bool last);

// u and v at t along a side, and the point of a patch there.
std::array<double, 2> place_on_side(int side, double t);
SurfacePoint on_side(const SplinePatch& patch, int side, double t);

}  // namespace fairing
