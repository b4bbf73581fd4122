// SPDX-License-Identifier: GPL-3.0-or-later
// The one iterator over the points of a level. They come as *runs* of consecutive numbers: a
// control vertex (one point), the inside of a control edge (n - 1 points), a row inside a control
// face. All neighbours of a run are runs too, one step aside, so that loops along a run need no
// index:
//
//   for_each_run(grid, visit)                        on this thread, in the order of the points
//   for_each_run(grid, workers, make_state, visit)   in parallel
//   RunGather(grid, x)(run)                          x on a run and on its neighbours
//   accumulate_runs(grid, …) (grid/accumulate.h)     sums of what runs add to their neighbours
//
// Every run is visited once, by one thread. So visits that write to their own points or elements
// have the same result for any number of threads.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "grid/ring.h"
#include "parallel/cancel.h"
#include "parallel/workers.h"

namespace fairing {

enum class RunKind : std::uint8_t { vertex, edge, face_row };

// A control vertex, edge or face.
struct Element {
  RunKind kind;
  Index element;
};

// How many neighbours the points of an element have.
inline std::size_t neighbours(const ControlMesh& mesh, const Element& of) {
  switch (of.kind) {
    case RunKind::vertex: return std::size_t(ring_size(mesh, of.element));
    case RunKind::edge: return std::size_t(EdgeRingLanes(mesh, of.element).size);
    default: return face_ring(mesh.faces[of.element].quad()).size();
  }
}

inline RegionPart part_of_region(const ControlMesh& mesh, const Element& of) {
  switch (of.kind) {
    case RunKind::vertex: return mesh.vertex_part(of.element);
    case RunKind::edge: return mesh.edge_part(of.element);
    default: return mesh.face_part(of.element);
  }
}

// Whether the surface has divided differences at the points of an element.
inline bool has_fit(const ControlMesh& mesh, const Element& of) {
  switch (of.kind) {
    case RunKind::vertex: return mesh.vertex_fit(of.element);
    case RunKind::edge: return mesh.edge_fit(of.element);
    default: return mesh.face_part(of.element) == RegionPart::inside;
  }
}

struct Run : Element {
  int row;            // from 1 inside a face; otherwise 0
  bool quad;          // whether it is a row of a quad
  std::size_t first;  // its first point
  std::size_t count;  // never 0
  // Of edges, during a visit: the places of their neighbours.
  const EdgeRingLanes* ring = nullptr;
};

// Points in row j inside a face.
constexpr std::size_t row_count(bool quad, int n, int j) {
  return std::size_t(quad ? n - 1 : n - 1 - j);
}

inline Run vertex_run(Index v) { return {{RunKind::vertex, v}, 0, false, std::size_t(v), 1}; }

// Calls visit(run) for the inside of an edge, if it has points.
template <class Visit>
void for_edge_run(const GridLevel& grid, Index e, Visit&& visit) {
  if (grid.n() == 1) return;
  const EdgeRingLanes ring(grid.mesh(), e);
  visit(Run{{RunKind::edge, e},
            0,
            false,
            std::size_t(grid.edge_base(e)),
            std::size_t(grid.n() - 1),
            &ring});
}

// Calls visit(run) for the rows inside a face, if it has any.
template <class Visit>
void for_face_runs(const GridLevel& grid, Index f, Visit&& visit) {
  const bool quad = grid.mesh().faces[f].quad();
  const int n = grid.n(), rows = quad ? n - 1 : n - 2;
  std::size_t first = std::size_t(grid.face_base(f));
  for (int j = 1; j <= rows; ++j) {
    stop_in_large_face(j);
    const std::size_t count = row_count(quad, n, j);
    visit(Run{{RunKind::face_row, f}, j, quad, first, count});
    first += count;
  }
}

// --- on one thread ---

// Calls visit(run) for all runs in the order of their points. Throws what visit() throws, and
// FairingError(cancelled).
template <class Visit>
void for_each_run(const GridLevel& grid, Visit&& visit) {
  const ControlMesh& mesh = grid.mesh();
  for (const Index v : Cancellable(mesh.vertex_count())) {
    visit(vertex_run(v));
  }
  for (const Index e : Cancellable(Index(mesh.edges.size()))) {
    for_edge_run(grid, e, visit);
  }
  for (const Index f : Cancellable(Index(mesh.faces.size()))) {
    for_face_runs(grid, f, visit);
  }
}

// --- in parallel ---

// The fewest elements worth a thread: about 512 points inside faces (n² each) or edges (n each), 64
// vertices with their rings.
constexpr std::size_t vertex_grain = 64;
inline std::size_t element_grain(int n) { return std::size_t(std::max(1, 512 / (n * n))); }
inline std::size_t edge_grain(int n) { return element_grain(n) * std::size_t(n); }

// body(begin, end) on parts of the level's control vertices, edges or faces, for work on whole
// elements. Errors as Workers::for_parts.
template <class Body>
void for_vertex_parts(const GridLevel& grid, Workers& workers, Body&& body) {
  workers.for_parts(std::size_t(grid.mesh().vertex_count()), vertex_grain,
                    [&](std::size_t begin, std::size_t end) { body(Index(begin), Index(end)); });
}
template <class Body>
void for_edge_parts(const GridLevel& grid, Workers& workers, Body&& body) {
  workers.for_parts(grid.mesh().edges.size(), edge_grain(grid.n()),
                    [&](std::size_t begin, std::size_t end) { body(Index(begin), Index(end)); });
}
template <class Body>
void for_face_parts(const GridLevel& grid, Workers& workers, Body&& body) {
  workers.for_parts(grid.mesh().faces.size(), element_grain(grid.n()),
                    [&](std::size_t begin, std::size_t end) { body(Index(begin), Index(end)); });
}

// Calls visit(run, state) for all runs. make_state() makes the state that a thread keeps from run
// to run (buffers, a RunGather); it is called once a part, of which there are some hundred. The
// rows of a face are visited one after another with the same state. Errors as Workers::for_parts.
template <class MakeState, class Visit>
void for_each_run(const GridLevel& grid, Workers& workers, MakeState&& make_state, Visit&& visit) {
  for_vertex_parts(grid, workers, [&](Index begin, Index end) {
    auto state = make_state();
    for (Index v = begin; v < end; ++v) visit(vertex_run(v), state);
  });
  const auto with = [&](auto& state) { return [&](const Run& run) { visit(run, state); }; };
  if (grid.n() == 1) return;  // all points are control vertices
  for_edge_parts(grid, workers, [&](Index begin, Index end) {
    auto state = make_state();
    for (Index e = begin; e < end; ++e) for_edge_run(grid, e, with(state));
  });
  for_face_parts(grid, workers, [&](Index begin, Index end) {
    auto state = make_state();
    for (Index f = begin; f < end; ++f) for_face_runs(grid, f, with(state));
  });
}

// The same for visits without a state: visit(run).
template <class Visit>
void for_each_run(const GridLevel& grid, Workers& workers, Visit&& visit) {
  for_each_run(grid, workers, [] { return 0; }, [&](const Run& run, int) { visit(run); });
}

// One sum per element, added in the elements' order, so that it does not depend on the number of
// threads.
class ElementSums {
 public:
  explicit ElementSums(const ControlMesh& mesh)
      : mesh_(mesh),
        first_edge_(std::size_t(mesh.vertex_count())),
        first_face_(first_edge_ + mesh.edges.size()),
        sum_(first_face_ + mesh.faces.size(), 0.0) {}

  double& vertex(Index v) { return sum_[v]; }
  double& edge(Index e) { return sum_[first_edge_ + std::size_t(e)]; }
  double& face(Index f) { return sum_[first_face_ + std::size_t(f)]; }
  double& of(const Run& run) {
    switch (run.kind) {
      case RunKind::vertex: return vertex(run.element);
      case RunKind::edge: return edge(run.element);
      default: return face(run.element);
    }
  }
  // The total without copies of elements.
  double total() const {
    double total = 0;
    for (std::size_t i = 0; i < sum_.size(); ++i)
      if (mesh_.copies.face.empty() || !second(i)) total += sum_[i];
    return total;
  }

 private:
  bool second(std::size_t i) const {
    if (i < first_edge_) return mesh_.second_vertex(Index(i));
    return i < first_face_ ? mesh_.second_edge(Index(i - first_edge_))
                           : mesh_.second_face(Index(i - first_face_));
  }

  const ControlMesh& mesh_;
  std::size_t first_edge_, first_face_;
  std::vector<double> sum_;
};

// --- neighbours ---

// Slot 0 is a point itself, slots 1 … are its neighbours in the order of its chart (grid/ring.h).
// The C numbers of slot s of a run's point i are at at[s] + C * i.
constexpr int most_slots = 9;  // of edges and faces; vertices may have any number

template <class T>
struct RunNeighbours {
  T* at[most_slots];
};

// For the inside of an edge, whose lanes are those of EdgeRingLanes.
template <class T, int C = 1>
inline void set_beside_edge(const EdgeRingLanes& ring, T* const* lane, RunNeighbours<T>& out) {
  out.at[0] = lane[0] + C;
  for (int j = 0; j < ring.size; ++j) out.at[j + 1] = lane[ring.lane[j]] + C * (1 + ring.at[j]);
}
template <class T, int C = 1>
inline RunNeighbours<T> beside_edge(const EdgeRingLanes& ring, T* const* lane) {
  RunNeighbours<T> out;
  set_beside_edge<T, C>(ring, lane, out);
  return out;
}

// For row j inside a closed face (gather_face).
template <class T, int C = 1>
inline void set_beside_row(bool quad, int n, int j, T* closed, RunNeighbours<T>& out) {
  const auto at = [&](int i, int k) {
    return closed + C * (closed_row(quad, std::size_t(n), std::size_t(k)) + std::size_t(i));
  };
  out.at[0] = at(1, j);
  int s = 1;
  for (const GridPoint d : face_ring(quad)) out.at[s++] = at(1 + d.i, j + d.j);
}
template <class T, int C = 1>
inline RunNeighbours<T> beside_row(bool quad, int n, int j, T* closed) {
  RunNeighbours<T> out;
  set_beside_row<T, C>(quad, n, j, closed, out);
  return out;
}

// The same pointers for a vertex, of any valence.
template <class T>
class SpokePointers {
 public:
  void start(T* own) {
    few_.at[0] = own;
    size_ = 1;
  }
  void add(T* neighbour) {
    if (size_ < most_slots) {
      few_.at[size_++] = neighbour;
      return;
    }
    if (size_++ == most_slots) many_.assign(few_.at, few_.at + most_slots);
    many_.push_back(neighbour);
  }
  T* const* list() const { return size_ <= most_slots ? few_.at : many_.data(); }

 private:
  RunNeighbours<T> few_;
  std::vector<T*> many_;
  int size_ = 0;
};

// Reads x, C numbers a point, on runs and next to them: gather(run)[s] + C * i is slot s of point
// i. Valid until the next run. A face is gathered once, at its first row, into a buffer of the
// thread; two gathers of the same type that are used alternately need a buffer each.
template <class T, int C = 1>
class RunGather {
 public:
  RunGather(const GridLevel& grid, const T* x,
            std::vector<T>& buffer = thread_scratch<T>().gathered)
      : grid_(grid), x_(x), buffer_(buffer) {}

  const T* const* operator()(const Run& run) {
    if (run.kind == RunKind::vertex) {
      spokes_.start(x_ + C * run.first);
      visit_ring(grid_, run.element,
                 [&](Index p, std::size_t) { spokes_.add(x_ + C * std::size_t(p)); });
      return spokes_.list();
    }
    if (run.kind == RunKind::edge) {
      const EdgeLanes<T, C> lanes(grid_, x_, run.element, buffer_);
      const T* const lane[3] = {lanes.lane[0], lanes.lane[1], lanes.lane[2]};
      set_beside_edge<const T, C>(*run.ring, lane, beside_);
      return beside_.at;
    }
    const int n = grid_.n();
    if (run.row == 1) {
      closed_ = room_in(buffer_, C * closed_size(run.quad, std::size_t(n)) + lane_block);
      gather_face<C>(grid_, x_, run.element, closed_);
    }
    set_beside_row<const T, C>(run.quad, n, run.row, closed_, beside_);
    return beside_.at;
  }

 private:
  const GridLevel& grid_;
  const T* x_;
  std::vector<T>& buffer_;
  T* closed_ = nullptr;
  RunNeighbours<const T> beside_;
  SpokePointers<const T> spokes_;
};

// Appends the ring of a run's point i to `ids`, in the order of its slots 1 ….
inline void append_ring(const GridLevel& grid, const Run& run, std::size_t i,
                        std::vector<Index>& ids) {
  switch (run.kind) {
    case RunKind::vertex:
      visit_ring(grid, run.element, [&](Index p, std::size_t) { ids.push_back(p); });
      return;
    case RunKind::edge: append_ring(grid, run.element, *run.ring, int(i) + 1, ids); return;
    case RunKind::face_row: append_ring(grid, run.element, GridPoint{int(i) + 1, run.row}, ids);
  }
}

}  // namespace fairing
