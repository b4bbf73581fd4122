// SPDX-License-Identifier: GPL-3.0-or-later
// Sums of local contributions over a level, in parallel and bit-identical for any number of
// threads: a contribution to a point of another element is written to its own slot, and added by
// the element of the point.
#pragma once

#include <cstdint>
#include <vector>

#include "grid/runs.h"
#include "parallel/memory.h"

namespace fairing {

// Which points are unknowns.
struct Unknowns {
  std::vector<std::uint8_t> vertex, edge;  // per control vertex, per control edge
  bool any_vertex = false;
  std::vector<std::uint8_t> face{};  // per control face; empty: all

  bool has_face(std::size_t f) const { return face.empty() || face[f]; }
  // Whether the points of a run are unknowns.
  bool has(const Run& run) const {
    const auto element = std::size_t(run.element);
    switch (run.kind) {
      case RunKind::vertex: return vertex[element] != 0;
      case RunKind::edge: return edge[element] != 0;
      default: return has_face(element);
    }
  }
};

// The slots of one level; they also fit coarser levels.
template <class T, int C = 3>
struct ElementSlots {
  Array<T> row;    // per side: the edge's share of the face's first row, in the edge's direction
  Array<T> side;   // per side: the face's contribution to the side's points 0 … n - 1
  Array<T> end;    // per edge: its contribution to its two ends
  Array<T> spoke;  // per spoke: the vertex' contribution to the points along it and across its quad

  void fit(const GridLevel& grid) {
    const auto& mesh = grid.mesh();
    const std::size_t n = std::size_t(grid.n()), sides = mesh.sides.size();
    grow(row, sides * lane_stride<C>(grid.n()));
    grow(side, C * sides * n);
    grow(end, 2 * C * mesh.edges.size());
    grow(spoke, 2 * C * mesh.spokes.size());
  }

 private:
  static void grow(Array<T>& a, std::size_t size) {
    if (a.size() < size) a.resize(size);
  }
};

// out <- the sum of what the three bodies contribute; zero on points that are not unknowns (all
// points count when `unknowns` is null). Each body writes what one control element adds:
//
//   vertex_body(v, centre, spokes, scratch)   adds to zeros. centre: the vertex itself; spokes: two
//                                             points a spoke of its ring (the slots of visit_ring)
//   edge_body(e, run, left, right, scratch)   sets all. run: points 0 … n of the edge; left, right:
//                                             the rows next to it, in its direction, null without a
//                                             face; lane_stride<C>(n) numbers each
//   face_body(f, closed, scratch)             sets all. closed: the closed face, row by row, and
//                                             lane_block numbers more
//
// Faces that are not unknowns have no unknowns about them; face_body is not called for them.
// `scratch` is a vector of the thread's to work in, empty at first. Errors as Workers::for_parts.
//
// Instead of `scratch`, bodies may get what make_state() gives; it is called once a part of the
// elements.
template <class T, int C, class MakeState, class VertexBody, class EdgeBody, class FaceBody>
void accumulate(const GridLevel& grid, Workers& workers, ElementSlots<T, C>& slots,
                const Unknowns* unknowns, T* out, MakeState&& make_state, VertexBody&& vertex_body,
                EdgeBody&& edge_body, FaceBody&& face_body) {
  const ControlMesh& mesh = grid.mesh();
  const int n = grid.n();
  const std::size_t un = std::size_t(n), row_stride = lane_stride<C>(n), side_stride = C * un;
  slots.fit(grid);

  for_vertex_parts(grid, workers, [&](Index begin, Index end) {
    decltype(auto) state = make_state();
    for (std::size_t v = std::size_t(begin); v < std::size_t(end); ++v) {
      T* spokes = slots.spoke.data() + 2 * C * std::size_t(mesh.ring_offset[v]);
      std::fill(spokes, slots.spoke.data() + 2 * C * std::size_t(mesh.ring_offset[v + 1]), T(0));
      std::fill(out + C * v, out + C * v + C, T(0));
      vertex_body(Index(v), out + C * v, spokes, state);
    }
  });

  for_edge_parts(grid, workers, [&](Index begin, Index end) {
    T* const run = room_in(thread_scratch<T>().run, row_stride);
    decltype(auto) state = make_state();
    for (std::size_t e = std::size_t(begin); e < std::size_t(end); ++e) {
      const Edge& edge = mesh.edges[e];
      T* rows[2];
      for (std::size_t h = 0; h < 2; ++h) {
        rows[h] =
            edge.side[h] < 0 ? nullptr : slots.row.data() + row_stride * std::size_t(edge.side[h]);
      }
      edge_body(Index(e), run, rows[0], rows[1], state);
      T* end_slot = slots.end.data() + 2 * C * e;
      copy_point<C>(end_slot, run);
      copy_point<C>(end_slot + C, run + C * n);
      std::copy(run + C, run + C * n, out + C * std::size_t(grid.edge_base(Index(e))));
    }
  });

  for_face_parts(grid, workers, [&](Index begin, Index end) {
    T* const closed = room_in(thread_scratch<T>().closed, C * closed_size(true, un) + lane_block);
    decltype(auto) state = make_state();
    for (std::size_t f = std::size_t(begin); f < std::size_t(end); ++f) {
      const Face& face = mesh.faces[f];
      const bool quad = face.quad();
      T* side = slots.side.data() + side_stride * std::size_t(face.first_side);
      if (unknowns && !unknowns->has_face(f)) {
        T* inside = out + C * std::size_t(grid.face_base(Index(f)));
        std::fill(inside, inside + C * interior_size(quad, n), T(0));
        std::fill(side, side + side_stride * std::size_t(face.size), T(0));
        continue;
      }
      face_body(Index(f), closed, state);
      const Side* sides = mesh.sides.data() + face.first_side;
      const T* rows = slots.row.data() + row_stride * std::size_t(face.first_side);
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
        const Index spoke = mesh.spoke_of_side[face.first_side + c];
        add_point<C>(&closed[C * side_offset(true, n, c, 1, 1)],
                     slots.spoke.data() + 2 * C * std::size_t(spoke) + C);
      }
      scatter_interior<C>(grid, closed, Index(f), out);
      with_shape(quad, n, [&]<bool four, int fixed>() {
        const int m = fixed ? fixed : n;
        T* to = side;
        for (int s = 0; s < (four ? 4 : 3); ++s) {
          SideWalk walk = side_walk(four, m, s, 0, 0);
          for (int k = 0; k < m; ++k, walk.next(), to += C)
            copy_point<C>(to, closed + C * walk.offset);
        }
      });
    }
  });

  for_edge_parts(grid, workers, [&](Index begin, Index end) {
    for (std::size_t e = std::size_t(begin); e < std::size_t(end) && n > 1; ++e) {
      const Edge& edge = mesh.edges[e];
      T* run = out + C * std::size_t(grid.edge_base(Index(e)));
      if (unknowns && !unknowns->edge[e]) {
        std::fill(run, run + C * (n - 1), T(0));
        continue;
      }
      if (edge.side[0] >= 0) {
        const T* side = slots.side.data() + side_stride * std::size_t(edge.side[0]);
        for (int k = C; k < C * n; ++k) run[k - C] += side[k];
      }
      if (edge.side[1] >= 0) {
        const T* side = slots.side.data() + side_stride * std::size_t(edge.side[1]);
        for (int k = 1; k < n; ++k) add_point<C>(run + C * (k - 1), side + C * (n - k));
      }
      for (std::size_t h = 0; h < 2; ++h)
        add_point<C>(run + (h == 0 ? 0 : C * (n - 2)),
                     slots.spoke.data() + 2 * C * std::size_t(mesh.spoke_of_edge[2 * e + h]));
    }
  });

  if (unknowns && !unknowns->any_vertex) {
    std::fill(out, out + C * std::size_t(mesh.vertex_count()), T(0));
    return;
  }
  for_vertex_parts(grid, workers, [&](Index begin, Index end) {
    for (std::size_t v = std::size_t(begin); v < std::size_t(end); ++v) {
      T* centre = out + C * v;
      if (unknowns && !unknowns->vertex[v]) {
        std::fill(centre, centre + C, T(0));
        continue;
      }
      for (const Spoke& spoke : mesh.ring(Index(v))) {
        add_point<C>(centre,
                     slots.end.data() + 2 * C * std::size_t(spoke.edge) + (spoke.outward ? 0 : C));
        if (spoke.face >= 0) {
          const Face& face = mesh.faces[spoke.face];
          add_point<C>(centre, slots.side.data() +
                                   side_stride * std::size_t(face.first_side + spoke.corner));
        }
        if (n == 1)
          add_point<C>(centre, slots.spoke.data() +
                                   2 * C *
                                       std::size_t(mesh.spoke_of_edge[2 * std::size_t(spoke.edge) +
                                                                      (spoke.outward ? 1 : 0)]));
      }
    }
  });
}

template <class T, int C, class VertexBody, class EdgeBody, class FaceBody>
void accumulate(const GridLevel& grid, Workers& workers, ElementSlots<T, C>& slots,
                const Unknowns* unknowns, T* out, VertexBody&& vertex_body, EdgeBody&& edge_body,
                FaceBody&& face_body) {
  const auto scratch = []() -> std::vector<T>& {
    std::vector<T>& work = thread_scratch<T>().work;
    work.clear();
    return work;
  };
  accumulate(grid, workers, slots, unknowns, out, scratch, vertex_body, edge_body, face_body);
}

// The same for contributions of runs to themselves and their neighbours: body(run, target, state)
// adds the contribution to slot s of the run's point i to target[s] + C * i, which is zero at
// first. The slots of a run overlap, so the order of additions in body is the order of the sums.
// make_state() is that of for_each_run.
template <class T, int C, class MakeState, class Body>
void accumulate_runs(const GridLevel& grid, Workers& workers, ElementSlots<T, C>& slots,
                     const Unknowns* unknowns, T* out, MakeState&& make_state, Body&& body) {
  using State = decltype(make_state());
  struct Both {
    State own;
    SpokePointers<T> spokes{};
    RunNeighbours<T> beside{};
  };
  accumulate(
      grid, workers, slots, unknowns, out, [&] { return Both{make_state()}; },
      [&](Index v, T* centre, T* spokes, Both& state) {
        state.spokes.start(centre);
        visit_ring(grid, v, [&](Index, std::size_t slot) { state.spokes.add(spokes + C * slot); });
        body(vertex_run(v), state.spokes.list(), state.own);
      },
      [&](Index e, T* run, T* left, T* right, Both& state) {
        clear_lanes<C>(grid.n(), run, left, right);
        T* const lane[3] = {run, left, right};
        for_edge_run(grid, e, [&](const Run& edge) {
          set_beside_edge<T, C>(*edge.ring, lane, state.beside);
          body(edge, state.beside.at, state.own);
        });
      },
      [&](Index f, T* closed, Both& state) {
        const bool quad = grid.mesh().faces[f].quad();
        std::fill_n(closed, C * closed_size(quad, std::size_t(grid.n())), T(0));
        for_face_runs(grid, f, [&](const Run& row) {
          set_beside_row<T, C>(quad, grid.n(), row.row, closed, state.beside);
          body(row, state.beside.at, state.own);
        });
      });
}

}  // namespace fairing
