// SPDX-License-Identifier: GPL-3.0-or-later
// A start for the next surface, extrapolated from the last two that were found.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "base/types.h"
#include "fairing/surface.h"
#include "parallel/memory.h"
#include "parallel/workers.h"

namespace fairing {

// Let p be the last control positions, x their thin-plate surface, and p*, x* those of an earlier
// moment. The surface depends on the control positions by one linear map, the same for x, y and z,
// which commutes with affine maps of space. So if the next positions are
//
//   p' = p + t + A p + B (p - p*)
//
// with one vector t and two 3 x 3 matrices A and B for all vertices, their surface is
//
//   x' = x + t + A x + B (x - x*).
//
// While part of a mesh is dragged, turned or scaled, p' has this form from the second update on,
// and the start is the solution but for rounding. Otherwise t, A and B are those of the nearest
// positions of this form, and the solve has the rest to do. All in working coordinates.
class RecentSurfaces {
 public:
  explicit RecentSurfaces(Workers& workers) : workers_(workers) {}

  bool empty() const { return !known_; }
  void forget() {
    known_ = has_earlier_ = false;
    surface_ = {};
    earlier_plate_ = {};
  }

  // The last surface.
  Surface& surface() { return surface_; }
  // `surface` is that of these control positions.
  void remember(Surface surface, std::span<const Vec3> positions);

  // surface().plate <- x' for the p' of the form above that is nearest to these positions in least
  // squares; the loads on pads change likewise, except for translations. The caller solves from
  // there to the surface of these positions. May throw FairingError(cancelled) and bad_alloc.
  void extrapolate(std::span<const Vec3> positions);
  // That p', to which surface() belongs now.
  const std::vector<Vec3>& extrapolated() const { return extrapolated_; }

 private:
  // t, A and B, transposed, stacked.
  using Coefficients = Eigen::Matrix<double, 7, 3>;
  Coefficients fit(std::span<const Vec3> positions) const;

  Workers& workers_;
  bool known_ = false, has_earlier_ = false;
  std::vector<Vec3> positions_, earlier_positions_, extrapolated_;
  // The earlier surface, from before the current kind of change, so that p - p* grows during a
  // drag.
  Surface surface_;
  Array<double> earlier_plate_;
  Loads earlier_loads_;
};

}  // namespace fairing
