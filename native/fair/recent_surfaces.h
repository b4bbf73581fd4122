// SPDX-License-Identifier: GPL-3.0-or-later
// Surfaces found before, as a start for the next one.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "control_mesh/control_mesh.h"
#include "execution/memory.h"
#include "execution/workers.h"

namespace fairing {

// The thin plate's surface is one linear map of the control positions, the same for x, y and z, and affine images stay so.
// Hence positions that are an affine image of the last ones, plus a mixture of the coordinates of an earlier change, have
// the surface mixed in the same way. Once a drag, turn or scaling of a part of the mesh has begun, what follows of it is
// such a mixture.
class RecentSurfaces {
 public:
  explicit RecentSurfaces(Workers& workers) : workers_(workers) {}

  bool empty() const { return !known_; }
  void forget() { known_ = anchored_ = false; }

  // The latest surface, 3 numbers a point; to be set to the next one before took().
  Array<double>& surface() { return surface_; }
  // surface() is that of these control positions.
  void took(std::span<const Vec3> places);

  // surface() <- the mixture nearest to these positions.
  void foresee(std::span<const Vec3> places);
  // Where the mixture has the control vertices.
  const std::vector<Vec3>& foreseen() const { return foreseen_; }

 private:
  // Of 1, the last positions and the earlier change, for the change now.
  using Shares = Eigen::Matrix<double, 7, 3>;
  Shares shares_of(std::span<const Vec3> places) const;

  Workers& workers_;
  bool known_ = false, anchored_ = false;
  std::vector<Vec3> places_, anchor_places_, foreseen_;
  Array<double> surface_, anchor_;  // the latter is from before the present kind of change
};

}  // namespace fairing
