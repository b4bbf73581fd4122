// SPDX-License-Identifier: GPL-3.0-or-later
// The cells of a level, triangles and quads between its points, as a surface to project points on.
// Finds the cells at a point, and the place of a cell in its control face.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "grid/grid_level.h"
#include "parallel/memory.h"
#include "parallel/workers.h"

namespace fairing {

// A place on a cell: weights of its corners, three for a triangle.
using CornerShares = std::array<float, 4>;

// A place in a control face, in closed coordinates of a level (grid_level.h).
struct FacePlace {
  Index face;
  double i, j;
};

class Cells {
 public:
  // `grid` must outlive the cells. May throw FairingError(cancelled).
  Cells(const GridLevel& grid, Workers& workers);

  const GridLevel& grid() const { return grid_; }
  std::size_t size() const { return corner_.size(); }
  bool quad(Index cell) const { return corner_[cell][3] >= 0; }
  // Counter-clockwise; the fourth of a triangle is -1.
  const std::array<Index, 4>& corners(Index cell) const { return corner_[cell]; }
  Index face(Index cell) const { return face_[cell]; }

  // A cell at a point, and the corner that is the point.
  struct AtPoint {
    Index cell;
    std::uint8_t corner;
  };
  std::span<const AtPoint> at_point(Index p) const {
    const std::size_t begin = begin_[p], end = begin_[std::size_t(p) + 1];
    return {at_.data() + begin, end - begin};
  }

  FacePlace place(Index cell, const CornerShares& shares) const;
  // The cell of this level at a place in coordinates of level `of`, and its nearest corner.
  AtPoint cell_at(const FacePlace& place, int of) const;

  // Memory for each point of a level of quads.
  static constexpr std::int64_t bytes_a_point =
      sizeof(std::array<Index, 4>) + sizeof(Index) + sizeof(std::size_t) + 4 * sizeof(AtPoint);

 private:
  Index first_cell(Index face) const { return first_[face]; }

  const GridLevel& grid_;
  std::vector<Index> first_;  // by control face
  Array<std::array<Index, 4>> corner_;
  Array<Index> face_;
  Array<std::size_t> begin_;
  Array<AtPoint> at_;
};

}  // namespace fairing
