// SPDX-License-Identifier: GPL-3.0-or-later
// A surface's sheets joined again (mesh/sheets.h): what is a copy on the grid is one point with its
// original in the result. Points keep their order. Of a double cover's halves the mean is taken, so
// that the surface is as smooth where these are joined as anywhere.
#pragma once

#include "grid/grid_level.h"

namespace fairing {

class JoinedSheets {
 public:
  // `grid` must outlive it.
  explicit JoinedSheets(const GridLevel& grid);

  // False where nothing is a copy: all that follows changes nothing then.
  bool needed() const { return vertices_.copies < vertices_.end; }
  // Points of the result.
  std::size_t size() const;
  // Where the grid's point p is in the result.
  Index operator()(Index p) const;
  // out <- `points`, the grid's, 3 numbers each, without copies; may be the same array. Of double
  // covers the first half becomes the mean of both in `points`.
  void join(double* points, double* out) const;

 private:
  void set_means(double* points) const;

  const GridLevel& grid_;
  // Of what is copied, in the order of the grid's points.
  struct Block {
    Index begin, copies, end;
  };
  Block vertices_, centres_, edges_, faces_;
};

}  // namespace fairing
