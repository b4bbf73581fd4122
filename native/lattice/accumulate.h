// SPDX-License-Identifier: GPL-3.0-or-later
// Sums of local contributions over a level, in parallel and bit-identical for any number of threads: every
// contribution that leaves the element where it was computed is put down in a slot of its own, and picked up by the
// element that it belongs to.
#pragma once

#include <cstdint>
#include <vector>

#include "execution/memory.h"
#include "execution/scratch.h"
#include "execution/workers.h"
#include "lattice/closed_face.h"

namespace fairing {

// Which points are unknowns.
struct Unknowns {
  std::vector<std::uint8_t> vertex, edge;  // per control vertex, per control edge
  bool any_vertex = false;
  std::vector<std::uint8_t> face{};  // per control face; empty: all of them

  bool has_face(std::size_t f) const { return face.empty() || face[f]; }
};

// The slots of one level. May serve smaller levels too (`fit` grows them).
template <class T, int C = 3>
struct Exchange {
  Array<T> row;    // per side: what the edge adds to the face's first row, in the edge's direction
  Array<T> side;   // per side: what the face adds to its points 0 … n - 1
  Array<T> end;    // per edge: what it adds to its two ends
  Array<T> spoke;  // per spoke: what the vertex adds to the point along it, and across the quad behind it

  void fit(const Lattice& lattice) {
    const auto& mesh = lattice.mesh();
    const std::size_t n = std::size_t(lattice.n()), sides = mesh.sides.size();
    grow(row, sides * lane_stride<C>(lattice.n()));
    grow(side, C * sides * n);
    grow(end, 2 * C * mesh.edges.size());
    grow(spoke, 2 * C * mesh.spokes.size());
  }

 private:
  static void grow(Array<T>& a, std::size_t size) {
    if (a.size() < size) a.resize(size);
  }
};

// Elements worth a thread of their own.
inline std::size_t element_grain(int n) { return std::size_t(std::max(1, 2048 / (n * n))); }

// out <- the sum of what the three bodies contribute; zero on points that are not unknowns (all points count when
// `unknowns` is null). Bodies:
//   vertex_body(v, centre, spokes, scratch)   adds to zeros. centre: one point; spokes: two points a spoke of v's ring
//   edge_body(e, run, left, right, scratch)   sets all. run: points 0 … n of the edge; left, right: the rows next to
//                                             it, in its direction (null without a face); lane_stride<C>(n) numbers each
//   face_body(f, closed, scratch)             sets all. closed: the closed face, row by row, and a block more; not
//                                             called for faces that are not unknowns, around which nothing is
// `scratch` is a vector of the calling thread's to work in, empty at first.
template <class T, int C, class VertexBody, class EdgeBody, class FaceBody>
void accumulate(const Lattice& lattice, Workers& workers, Exchange<T, C>& exchange, const Unknowns* unknowns,
                T* out, VertexBody&& vertex_body, EdgeBody&& edge_body, FaceBody&& face_body) {
  const ControlMesh& mesh = lattice.mesh();
  const int n = lattice.n();
  const std::size_t un = std::size_t(n), row_stride = lane_stride<C>(n), side_stride = C * un;
  exchange.fit(lattice);

  workers.for_parts(std::size_t(mesh.vertex_count()), 256, [&](std::size_t begin, std::size_t end) {
    std::vector<T>& scratch = thread_scratch<T>().work;
    scratch.clear();
    for (std::size_t v = begin; v < end; ++v) {
      T* spokes = exchange.spoke.data() + 2 * C * std::size_t(mesh.ring_offset[v]);
      std::fill(spokes, exchange.spoke.data() + 2 * C * std::size_t(mesh.ring_offset[v + 1]), T(0));
      std::fill(out + C * v, out + C * v + C, T(0));
      vertex_body(Index(v), out + C * v, spokes, scratch);
    }
  });

  workers.for_parts(mesh.edges.size(), element_grain(n) * un, [&](std::size_t begin, std::size_t end) {
    T* const run = room_in(thread_scratch<T>().run, row_stride);
    std::vector<T>& scratch = thread_scratch<T>().work;
    scratch.clear();
    for (std::size_t e = begin; e < end; ++e) {
      const Edge& edge = mesh.edges[e];
      T* rows[2];
      for (std::size_t h = 0; h < 2; ++h) {
        rows[h] = edge.side[h] < 0 ? nullptr : exchange.row.data() + row_stride * std::size_t(edge.side[h]);
      }
      edge_body(Index(e), run, rows[0], rows[1], scratch);
      T* end_slot = exchange.end.data() + 2 * C * e;
      copy_point<C>(end_slot, run);
      copy_point<C>(end_slot + C, run + C * n);
      std::copy(run + C, run + C * n, out + C * std::size_t(lattice.edge_base(Index(e))));
    }
  });

  workers.for_parts(mesh.faces.size(), element_grain(n), [&](std::size_t begin, std::size_t end) {
    T* const closed = room_in(thread_scratch<T>().closed, C * closed_size(true, un) + lane_block);
    std::vector<T>& scratch = thread_scratch<T>().work;
    scratch.clear();
    for (std::size_t f = begin; f < end; ++f) {
      const Face& face = mesh.faces[f];
      const bool quad = face.quad();
      T* side = exchange.side.data() + side_stride * std::size_t(face.first_side);
      if (unknowns && !unknowns->has_face(f)) {
        T* inside = out + C * std::size_t(lattice.face_base(Index(f)));
        std::fill(inside, inside + C * interior_size(quad, n), T(0));
        std::fill(side, side + side_stride * std::size_t(face.size), T(0));
        continue;
      }
      face_body(Index(f), closed, scratch);
      const Side* sides = mesh.sides.data() + face.first_side;
      const T* rows = exchange.row.data() + row_stride * std::size_t(face.first_side);
      with_shape(quad, n, [&]<bool four, int fixed>() {
        const int m = fixed ? fixed : n;
        for (int s = 0; s < (four ? 4 : 3) && m > 1; ++s) {
          const T* row = rows + row_stride * std::size_t(s);
          const std::ptrdiff_t step = sides[s].reversed ? -C : C;
          if (step < 0) row += C * (row_size(four, m) - 1);
          SideWalk walk = side_walk(four, m, s, 0, 1);
          for (int k = 0; k < row_size(four, m); ++k, walk.next(), row += step)
            add_point<C>(closed + C * walk.offset, row);
        }
      });
      for (int c = 0; c < 4 && quad; ++c) {
        const Index spoke = mesh.spoke_of_side[std::size_t(face.first_side + c)];
        add_point<C>(&closed[C * side_offset(true, n, c, 1, 1)],
                     exchange.spoke.data() + 2 * C * std::size_t(spoke) + C);
      }
      scatter_interior<C>(lattice, closed, Index(f), out);
      with_shape(quad, n, [&]<bool four, int fixed>() {
        const int m = fixed ? fixed : n;
        T* to = side;
        for (int s = 0; s < (four ? 4 : 3); ++s) {
          SideWalk walk = side_walk(four, m, s, 0, 0);
          for (int k = 0; k < m; ++k, walk.next(), to += C) copy_point<C>(to, closed + C * walk.offset);
        }
      });
    }
  });

  workers.for_parts(mesh.edges.size(), element_grain(n) * un, [&](std::size_t begin, std::size_t end) {
    for (std::size_t e = begin; e < end && n > 1; ++e) {
      const Edge& edge = mesh.edges[e];
      T* run = out + C * std::size_t(lattice.edge_base(Index(e)));
      if (unknowns && !unknowns->edge[e]) {
        std::fill(run, run + C * (n - 1), T(0));
        continue;
      }
      if (edge.side[0] >= 0) {
        const T* side = exchange.side.data() + side_stride * std::size_t(edge.side[0]);
        for (int k = C; k < C * n; ++k) run[k - C] += side[k];
      }
      if (edge.side[1] >= 0) {
        const T* side = exchange.side.data() + side_stride * std::size_t(edge.side[1]);
        for (int k = 1; k < n; ++k) add_point<C>(run + C * (k - 1), side + C * (n - k));
      }
      for (std::size_t h = 0; h < 2; ++h)
        add_point<C>(run + (h == 0 ? 0 : C * (n - 2)),
                     exchange.spoke.data() + 2 * C * std::size_t(mesh.spoke_of_edge[2 * e + h]));
    }
  });

  if (unknowns && !unknowns->any_vertex) {
    std::fill(out, out + C * std::size_t(mesh.vertex_count()), T(0));
    return;
  }
  workers.for_parts(std::size_t(mesh.vertex_count()), 256, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) {
      T* centre = out + C * v;
      if (unknowns && !unknowns->vertex[v]) {
        std::fill(centre, centre + C, T(0));
        continue;
      }
      for (const Spoke& spoke : mesh.ring(Index(v))) {
        add_point<C>(centre, exchange.end.data() + 2 * C * std::size_t(spoke.edge) + (spoke.outward ? 0 : C));
        if (spoke.face >= 0) {
          const Face& face = mesh.faces[std::size_t(spoke.face)];
          add_point<C>(centre,
                       exchange.side.data() + side_stride * std::size_t(face.first_side + spoke.corner));
        }
        if (n == 1)
          add_point<C>(
              centre,
              exchange.spoke.data() +
                  2 * C *
                      std::size_t(mesh.spoke_of_edge[2 * std::size_t(spoke.edge) + (spoke.outward ? 1 : 0)]));
      }
    }
  });
}

}  // namespace fairing
