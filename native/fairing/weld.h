// SPDX-License-Identifier: GPL-3.0-or-later
// A surface's sheets joined again (mesh/sheets.h): what is a copy on the grid is one point with its
// original in the result. Points keep their order.
#pragma once

#include "grid/grid_level.h"

namespace fairing {

class Weld {
 public:
  // `grid` must outlive it.
  explicit Weld(const GridLevel& grid);

  // False where nothing is a copy: all that follows changes nothing then.
  bool needed() const { return copies_ > 0; }
  // Points of the result.
  std::size_t size() const { return grid_.size() - std::size_t(copies_ + edge_copies_); }
  // Where the grid's point p is in the result.
  Index operator()(Index p) const;
  // out <- the grid's points, 3 numbers each, without copies; may be the same array.
  void join(const double* points, double* out) const;

 private:
  const GridLevel& grid_;
  // In the order of the grid's points: input vertices, copies, centres and edges, their copies.
  Index first_copy_, first_centre_, first_edge_copy_, first_face_;
  Index copies_, edge_copies_;
};

}  // namespace fairing
