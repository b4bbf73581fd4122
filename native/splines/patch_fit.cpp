// SPDX-License-Identifier: GPL-3.0-or-later
#include "splines/patch_fit.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include "base/angle.h"
#include "base/roundoff.h"
#include "splines/net_system.h"

namespace fairing {
namespace {

// Weights relative to distances along the lattice's normals: of a cross derivative's component out
// of the tangent plane at a side, and of third differences of the net.
constexpr double tilt = 0.3, rough = 1e-3;
// Tried one after another until one succeeds. `slide` is the weight of a sample's distance along
// the patch: the less it is, the sooner patches fold. In narrow corners patches fold with any
// `slide`, unless `shear`, a weight on the deviation of the net's cells from parallelograms, keeps
// the net's rows apart. `lean` says with which length an angle at a side becomes a distance: with
// the model's size; with the patch's width, since in a narrow patch the size would outweigh
// `shear`; or angles at sides have no weight.
enum class Lean { of_model, of_patch, free };
struct Way {
  double slide, shear;
  Lean lean = Lean::of_model;
};
constexpr double slides[] = {0.01, 0.1, 1};  // decades
constexpr Way ways[] = {{slides[1], 0}, {slides[2], 0}}, closest[] = {{slides[0], 0}};
constexpr Way in_place[] = {{slides[2], 0, Lean::of_patch}, {slides[2], 0, Lean::free}};
constexpr Way unfolding[] = {
    {slides[1], slides[1]}, {slides[1], slides[2]}, {slides[2], slides[2]}};
// Samples move to their feet and the patch is fitted again, as long as the largest distance falls
// below this share.
constexpr double improving = 0.7;
constexpr int least_refits = 2;  // with one less, angles are larger

// Sides first: v = 0 and v = 1, then the rest of u = 0 and u = 1.
SplinePatch with_sides(const PatchData& data, int spans_u, int spans_v) {
  SplinePatch out{spans_u, spans_v, {}};
  const int nu = control_points(spans_u), nv = control_points(spans_v);
  out.net.assign(std::size_t(nu) * std::size_t(nv), Vec3::Zero());
  for (const int s : {0, 2}) {
    const SplineCurve side = refined(data.side[std::size_t(s)], spans_u);
    for (int i = 0; i < nu; ++i)
      out.net[out.index(i, s ? nv - 1 : 0)] = side.points[std::size_t(i)];
  }
  for (const int s : {1, 3}) {
    const SplineCurve side = refined(data.side[std::size_t(s)], spans_v);
    for (int j = 1; j + 1 < nv; ++j)
      out.net[out.index(s == 1 ? nu - 1 : 0, j)] = side.points[std::size_t(j)];
  }
  return out;
}

std::array<NetTerm, 16> terms_of(const CubicBasis& bu, const CubicBasis& bv) {
  std::array<NetTerm, 16> out;
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j)
      out[std::size_t(4 * i + j)] = {bu.first + i, bv.first + j,
                                     bu.value[std::size_t(i)] * bv.value[std::size_t(j)]};
  return out;
}

// The derivative across a side, from its row of control points and the next one.
std::array<NetTerm, 8> across_side(const SplinePatch& patch, int side, double t) {
  const bool along_u = side % 2 == 0, far = side == 1 || side == 2;
  const int spans = along_u ? patch.spans_u : patch.spans_v,
            others = along_u ? patch.spans_v : patch.spans_u;
  const CubicBasis b = cubic_basis(spans, t);
  const int low = far ? control_points(others) - 2 : 0;
  std::array<NetTerm, 8> out;
  for (int k = 0; k < 8; ++k) {
    const int along = along_u ? k / 2 : k % 4, step = along_u ? k % 2 : k / 4;
    const double factor = 3.0 * others * b.value[std::size_t(along)] * (step ? 1 : -1);
    out[std::size_t(k)] = along_u ? NetTerm{b.first + along, low + step, factor}
                                  : NetTerm{low + step, b.first + along, factor};
  }
  return out;
}

double squared(double x) { return x * x; }

void add_shear(double shear, const SplinePatch& patch, NetSystem& system) {
  const int nu = control_points(patch.spans_u), nv = control_points(patch.spans_v);
  for (int i = 0; i + 1 < nu; ++i)
    for (int j = 0; j + 1 < nv; ++j) {
      const Vec3 n = patch.at((i + 0.5) / (nu - 1), (j + 0.5) / (nv - 1)).normal();
      const Eigen::Matrix3d within = Eigen::Matrix3d::Identity() - n * n.transpose();
      system.add(
          std::array<NetTerm, 4>{{{i, j, 1}, {i, j + 1, -1}, {i + 1, j, -1}, {i + 1, j + 1, 1}}},
          squared(shear) * within, Vec3::Zero());
    }
}

// A single fit. If `way` is null, all directions have the same weight, and derivatives across sides
// are free.
bool fit_once(const PatchData& data, SplinePatch& patch, const Way* way) {
  NetSystem system(patch);
  for (const PatchSample& sample : data.samples) {
    if (!sample.fitted) continue;
    Eigen::Matrix3d weight = Eigen::Matrix3d::Identity();
    const CubicBasis bu = cubic_basis(patch.spans_u, sample.u),
                     bv = cubic_basis(patch.spans_v, sample.v);
    if (way) {
      const Vec3 n = patch.at(bu, bv).normal();
      weight = squared(way->slide) * weight + (1 - squared(way->slide)) * n * n.transpose();
      system.balance(terms_of(bu, bv), sample.area * n, sample.at);
    }
    system.add(bu, bv, weight, sample.at);
  }
  system.add_third_differences(rough);
  if (way && way->shear > 0) add_shear(way->shear, patch, system);
  if (way && way->lean != Lean::free)
    for (int s = 0; s < 4; ++s)
      for (const SideNormal& n : data.normals[std::size_t(s)]) {
        const SurfacePoint p = on_side(patch, s, n.t);
        const double across = (s % 2 ? p.along_u : p.along_v).norm();
        const double scale = tilt * (way->lean == Lean::of_patch ? 1 : data.size / across);
        if (std::isfinite(scale))
          system.add(across_side(patch, s, n.t),
                     n.weight * squared(scale) * n.normal * n.normal.transpose(), Vec3::Zero());
      }
  SplinePatch solved = patch;
  // A patch of least squares may lie on one side of its samples. It is moved so that the volumes on
  // both sides are equal, if the move is less than its tolerance on average.
  if (!system.solve(solved, data.tolerance)) return false;
  patch = std::move(solved);
  return true;
}

void move_to_foot(const SplinePatch& patch, PatchSample& sample) {
  for (int step = 0; step < 6; ++step) {
    const SurfacePoint p = patch.at(sample.u, sample.v);
    const Slide slide = slide_to(sample.at - p.at, p.along_u, p.along_v);
    const double u = std::clamp(sample.u + slide.along_u, 0.0, 1.0),
                 v = std::clamp(sample.v + slide.along_v, 0.0, 1.0);
    const double change = std::max(std::abs(u - sample.u), std::abs(v - sample.v));
    sample.u = u;
    sample.v = v;
    if (change < single_roundoff) return;
  }
}

// For the samples that are fitted; returns the largest distance from the patch.
double move_to_feet(const SplinePatch& patch, PatchData& data) {
  double far = 0;
  for (PatchSample& sample : data.samples) {
    if (!sample.fitted) continue;
    move_to_foot(patch, sample);
    far = std::max(far, (patch.at(sample.u, sample.v).at - sample.at).norm());
  }
  return far;
}

// At the midpoints of the parts of each span: the patch may oscillate where no sample is near.
void measure_between(const PatchData& data, FittedPatch& out) {
  const SplinePatch& patch = out.patch;
  const int nu = steps_a_span * patch.spans_u, nv = steps_a_span * patch.spans_v;
  for (int i = 0; i < nu; ++i)
    for (int j = 0; j < nv; ++j) {
      const double u = (i + 0.5) / nu, v = (j + 0.5) / nv;
      const auto [by, place] =
          data.surface->height(patch.at(u, v).at, data.corner, u, v, out.residuals);
      double& most = out.residuals[std::size_t(place)];
      most = std::max(most, by);
    }
}

FittedPatch measured(const PatchData& data, SplinePatch patch) {
  FittedPatch out;
  out.residuals.assign(data.faces, 0.0);
  for (PatchSample sample : data.samples) {
    move_to_foot(patch, sample);
    const SurfacePoint p = patch.at(sample.u, sample.v);
    double& most = out.residuals[std::size_t(sample.place)];
    most = std::max(most, (p.at - sample.at).norm());
    // a zero normal has no angle: the signs of its zeros would make it 0 or 180 degrees
    if (!sample.normal.isZero())
      out.turned = std::max(out.turned, angle_between(p.normal(), sample.normal));
  }
  for (int s = 0; s < 4; ++s)
    for (const SideNormal& n : data.normals[std::size_t(s)]) {
      if (n.normal.isZero()) continue;
      double& angle = out.side_angle[std::size_t(s)];
      angle = std::max(angle, angle_between(on_side(patch, s, n.t).normal(), n.normal));
      out.turned = std::max(out.turned, angle);
    }
  out.patch = std::move(patch);
  measure_between(data, out);
  out.residual = *std::max_element(out.residuals.begin(), out.residuals.end());
  return out;
}

Misses misses(const PatchData& data, const FittedPatch& fitted) {
  if (!(fitted.turned < folded)) return {true, fitted.turned};
  const double angle = *std::max_element(fitted.side_angle.begin(), fitted.side_angle.end());
  return {false, std::max(fitted.residual / data.tolerance, angle / data.normal_tolerance)};
}

FittedPatch fitted_by(const Way& way, const PatchData& data, SplinePatch patch) {
  PatchData moved = data;
  double before = std::numeric_limits<double>::infinity();
  for (int round = 0;; ++round) {
    const double far = move_to_feet(patch, moved);
    const bool improves = far <= improving * before;  // false for NaN
    if (round >= least_refits && (far <= data.tolerance / 2 || !improves)) break;
    before = far;
    fit_once(moved, patch, &way);
  }
  FittedPatch out = measured(moved, std::move(patch));
  out.misses = misses(data, out);
  return out;
}

// At the lattice's parameters, with which a patch hardly folds if the lattice does not.
FittedPatch fitted_in_place(const PatchData& data, const SplinePatch& start) {
  FittedPatch best;
  for (const Way& way : in_place) {
    SplinePatch patch = start;
    fit_once(data, patch, &way);
    FittedPatch next = measured(data, std::move(patch));
    next.misses = misses(data, next);
    if (best.patch.net.empty() || next.misses < best.misses) best = std::move(next);
    if (!best.misses.folds) break;
  }
  return best;
}

}  // namespace

std::array<double, 2> place_on_side(int side, double t) {
  switch (side) {
    case 0: return {t, 0};
    case 1: return {1, t};
    case 2: return {t, 1};
    default: return {0, t};
  }
}

SurfacePoint on_side(const SplinePatch& patch, int side, double t) {
  const auto [u, v] = place_on_side(side, t);
  return patch.at(u, v);
}

FittedPatch fit_patch(const PatchData& data, int spans_u, int spans_v, bool last) {
  SplinePatch start = with_sides(data, spans_u, spans_v);
  fit_once(data, start, nullptr);
  FittedPatch best = data.own ? fitted_in_place(data, start) : fitted_by(ways[0], data, start);
  const auto try_all = [&](std::span<const Way> others, double enough) {
    for (const Way& way : others) {
      if (best.misses <= Misses{false, enough}) return;
      FittedPatch next = fitted_by(way, data, start);
      if (next.misses < best.misses) best = std::move(next);
    }
  };
  constexpr double any = std::numeric_limits<double>::infinity();
  try_all(std::span(ways).subspan(data.own ? 0 : 1), last ? 1 : any);
  if (last && !best.misses.folds) try_all(closest, 1);
  if (!data.may_fold) try_all(unfolding, any);
  return best;
}

}  // namespace fairing
