// SPDX-License-Identifier: GPL-3.0-or-later
// Copies of a face with its sides (a *closed* face), of an edge with its ends, and of the row next
// to a side, as contiguous arrays for loops without branches. Vectors on a level hold C interleaved
// numbers a point: three coordinates, or one displacement.
#pragma once

#include <algorithm>
#include <cstring>

#include "grid/grid_level.h"

namespace fairing {

template <int C = 3, class T>
inline void copy_point(T* to, const T* from) {
  for (int a = 0; a < C; ++a) to[a] = from[a];
}

template <int C = 3, class T>
inline void add_point(T* to, const T* from) {
  for (int a = 0; a < C; ++a) to[a] += from[a];
}

// Offset in a closed face of point k of side s.
inline std::size_t side_offset(bool quad, int n, int s, int k, int r = 0) {
  const GridPoint p = closed_point(quad, n, s, k, r);
  return closed_row(quad, std::size_t(n), std::size_t(p.j)) + std::size_t(p.i);
}

// Number of points in the row next to a side, its two ends (on other sides) included.
constexpr int row_size(bool quad, int n) { return quad ? n + 1 : n; }

// Size of an edge's lane: points 0 … n, padded to whole blocks, which loops may write.
constexpr int lane_block = 8;
template <int C = 3>
constexpr std::size_t lane_stride(int n) {
  return std::size_t((C * (n + 1) + lane_block - 1) / lane_block * lane_block);
}

// Zeros on an edge's run and the rows beside it.
template <int C = 3, class T>
void clear_lanes(int n, T* run, T* left, T* right) {
  for (T* lane : {run, left, right})
    if (lane) std::fill(lane, lane + lane_stride<C>(n), T(0));
}

// The offsets in closed storage of the points (k, r), (k + 1, r), … in side coordinates. Along
// sides 1 and 2 of a triangle rows become shorter, so the step changes by one each time.
struct SideWalk {
  std::ptrdiff_t offset, step, change;
  void next() {
    offset += step;
    step += change;
  }
};

inline SideWalk side_walk(bool quad, int n, int s, int k, int r) {
  SideWalk walk{std::ptrdiff_t(side_offset(quad, n, s, k, r)), 0, 0};
  const std::ptrdiff_t m = n, j = closed_point(quad, n, s, k, r).j;
  if (quad) {
    const std::ptrdiff_t steps[4] = {1, m + 1, -1, -(m + 1)};
    walk.step = steps[s];
  } else if (s == 0) {
    walk.step = 1;
  } else if (s == 1) {  // (i - 1, j + 1)
    walk.step = m - j;
    walk.change = -1;
  } else {  // (i, j - 1)
    walk.step = -(m + 2 - j);
    walk.change = -1;
  }
  return walk;
}

// The same among a face's interior points, for the row r = 1. These are a smaller closed face, and
// the row runs along its sides.
inline SideWalk interior_walk(bool quad, int n, int s, int k) {
  return side_walk(quad, quad ? n - 2 : n - 3, s, k - 1, 0);
}

// run <- x on the edge's points 0 … n.
template <int C = 3, class T>
void gather_edge(const GridLevel& grid, const T* x, Index e, T* run) {
  const Edge& edge = grid.mesh().edges[e];
  const int n = grid.n();
  copy_point<C>(run, x + C * std::size_t(edge.vertex[0]));
  std::memcpy(run + C, x + C * std::size_t(grid.edge_base(e)),
              std::size_t(C * (n - 1)) * sizeof(T));
  copy_point<C>(run + C * n, x + C * std::size_t(edge.vertex[1]));
}

// row <- x on the row next to a side (side coordinates (0 …, 1)), in the direction of the side's
// edge.
template <int C = 3, class T>
void gather_row(const GridLevel& grid, const T* x, const Side& side, T* row) {
  const Face& face = grid.mesh().faces[side.face];
  const int n = grid.n(), size = row_size(face.quad(), n), sides = face.size;
  const std::ptrdiff_t step = side.reversed ? -C : C;
  if (side.reversed) row += C * (size - 1);
  const auto side_at = [&](int s) -> const Side& { return grid.mesh().sides[face.first_side + s]; };
  copy_point<C>(
      row, x + C * std::size_t(grid.side_point(side_at((side.local + sides - 1) % sides), n - 1)));
  if (size > 2) {
    const T* inside = x + C * std::size_t(grid.face_base(side.face));
    SideWalk walk = interior_walk(face.quad(), n, side.local, 1);
    for (int k = 1; k < size - 1; ++k, walk.next())
      copy_point<C>(row + step * k, inside + C * walk.offset);
  }
  copy_point<C>(row + step * (size - 1),
                x + C * std::size_t(grid.side_point(side_at((side.local + 1) % sides), 1)));
}

// Calls body.template operator()<quad, n>(). Usual values of n are compile-time constants; n = 0 is
// for all others.
template <class Body>
inline void with_shape(bool quad, int n, Body&& body) {
  if (quad) {
    switch (n) {
      case 4: return body.template operator()<true, 4>();
      case 8: return body.template operator()<true, 8>();
      default: return body.template operator()<true, 0>();
    }
  }
  switch (n) {
    case 4: return body.template operator()<false, 4>();
    case 8: return body.template operator()<false, 8>();
    default: return body.template operator()<false, 0>();
  }
}

// closed <- x on the closed face, row by row.
template <int C = 3, class T>
void gather_face(const GridLevel& grid, const T* x, Index f, T* closed) {
  const Face& face = grid.mesh().faces[f];
  const Side* sides = grid.mesh().sides.data() + face.first_side;
  const T* inside = x + C * std::size_t(grid.face_base(f));
  with_shape(face.quad(), grid.n(), [&]<bool quad, int fixed>() {
    const int n = fixed ? fixed : grid.n();
    for (int s = 0; s < (quad ? 4 : 3); ++s) {
      SideWalk walk = side_walk(quad, n, s, 0, 0);
      copy_point<C>(closed + C * walk.offset, x + C * std::size_t(face.vertex[s]));
      walk.next();
      const bool back = sides[s].reversed;
      const std::ptrdiff_t step = back ? -C : C;
      const T* from =
          x + C * (std::size_t(grid.edge_base(sides[s].edge)) + std::size_t(back ? n - 2 : 0));
      for (int k = 1; k < n; ++k, walk.next(), from += step)
        copy_point<C>(closed + C * walk.offset, from);
    }
    T* to = closed + C * (n + 2);
    const T* from = inside;
    for (int j = 1, width = quad ? n - 1 : n - 2; j < n && width > 0; ++j) {
      std::memcpy(to, from, std::size_t(C * width) * sizeof(T));
      from += C * width;
      to += C * (quad ? n + 1 : n + 1 - j);
      if (!quad) --width;
    }
  });
}

// Writes the interior points of a closed face back.
template <int C = 3, class T>
void scatter_interior(const GridLevel& grid, const T* closed, Index f, T* x) {
  T* inside = x + C * std::size_t(grid.face_base(f));
  with_shape(grid.mesh().faces[f].quad(), grid.n(), [&]<bool quad, int fixed>() {
    const int n = fixed ? fixed : grid.n();
    const T* from = closed + C * (n + 2);
    T* to = inside;
    for (int j = 1, width = quad ? n - 1 : n - 2; j < n && width > 0; ++j) {
      std::memcpy(to, from, std::size_t(C * width) * sizeof(T));
      to += C * width;
      from += C * (quad ? n + 1 : n + 1 - j);
      if (!quad) --width;
    }
  });
}

}  // namespace fairing
