// SPDX-License-Identifier: GPL-3.0-or-later
// Points in space by place, with nanoflann.
#pragma once

#include <nanoflann.hpp>

#include "base/points.h"

namespace fairing {

// An adaptor for nanoflann: 3 numbers a point.
struct PointsOfTree {
  const double* x;
  std::size_t count;
  std::size_t kdtree_get_point_count() const { return count; }
  double kdtree_get_pt(std::size_t p, std::size_t a) const { return x[3 * p + a]; }
  template <class Box>
  bool kdtree_get_bbox(Box&) const {
    return false;
  }
};

using PointTree =
    nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<double, PointsOfTree, double>,
                                        PointsOfTree, 3, Index>;

}  // namespace fairing
