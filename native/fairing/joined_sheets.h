// SPDX-License-Identifier: GPL-3.0-or-later
// Joins a surface's sheets (mesh/sheets.h): copies and their original on the grid become one point
// of the result. Points keep their order. The two halves of a double cover are averaged, so that
// the surface is as smooth at their seam as elsewhere.
#pragma once

#include "grid/grid_level.h"
#include "parallel/memory.h"

namespace fairing {

class JoinedSheets {
 public:
  // `grid` must outlive it.
  explicit JoinedSheets(const GridLevel& grid);

  // False if there are no copies; then all that follows changes nothing.
  bool needed() const { return vertices_.copies < vertices_.end; }
  // Number of points of the result.
  std::size_t size() const;
  // Index in the result of the grid's point p.
  Index operator()(Index p) const;
  // out <- `points` of the grid, 3 numbers each, without copies; may be the same array. For double
  // covers the first half in `points` becomes the mean of both.
  void join(double* points, double* out) const;
  // The same in place.
  void join(Array<double>& points) const;

 private:
  void set_means(double* points) const;

  const GridLevel& grid_;
  // A range of the grid's points that has copies, in their order.
  struct Block {
    Index begin, copies, end;
  };
  Block vertices_, centres_, edges_, faces_;
};

}  // namespace fairing
