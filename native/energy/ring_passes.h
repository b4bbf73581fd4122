// SPDX-License-Identifier: GPL-3.0-or-later
// The passes of RingRows over a whole level: moments R x, their transpose, and R^T R x in one go. x has one number a
// point, moments have three.
#pragma once

#include "energy/ring_rows.h"

namespace fairing {

// Calls put(p, count, moment) for every run of points p … p + count - 1; moment holds three lanes of `count`.
template <class T, class Put>
void visit_moments(const RingRows& rows, Workers& workers, const T* x, Put&& put) {
  const Lattice& lattice = rows.lattice();
  const ControlMesh& mesh = lattice.mesh();
  const int n = lattice.n();
  workers.for_parts(std::size_t(mesh.vertex_count()), 256, [&](std::size_t begin, std::size_t end) {
    for (Index v = Index(begin); v < Index(end); ++v) {
      const RowRun<const float> run = rows.vertex(v);
      T moment[3];
      for (int c = 0; c < 3; ++c) moment[c] = T(run.at(c, 0, 0)) * x[v];
      int slot = 0;
      visit_ring(lattice, v, [&](Index p, std::size_t) {
        ++slot;
        for (int c = 0; c < 3; ++c) moment[c] += T(run.at(c, slot, 0)) * x[p];
      });
      put(std::size_t(v), std::size_t(1), moment);
    }
  });
  workers.for_parts(n > 1 ? mesh.edges.size() : 0, element_grain(n) * std::size_t(n),
                    [&](std::size_t begin, std::size_t end) {
                      std::vector<T> scratch, moment(3 * std::size_t(n));
                      for (Index e = Index(begin); e < Index(end); ++e) {
                        const RowRun<const float> run = rows.edge(e);
                        const EdgeLanes<T, 1> lanes(lattice, x, e, scratch);
                        forward(run, beside_edge<T>(EdgeRingLanes(mesh, e), lanes.lane).at, moment.data());
                        put(std::size_t(lattice.edge_base(e)), run.count, moment.data());
                      }
                    });
  workers.for_parts(mesh.faces.size(), element_grain(n), [&](std::size_t begin, std::size_t end) {
    T* const closed = room_in(thread_scratch<T>().gathered, closed_size(true, std::size_t(n)));
    std::vector<T> moment(3 * std::size_t(n));
    for (Index f = Index(begin); f < Index(end); ++f) {
      const bool quad = mesh.faces[std::size_t(f)].quad();
      gather_face<1>(lattice, x, f, closed);
      std::size_t p = std::size_t(lattice.face_base(f));
      for (int j = 1; j < n; ++j) {
        const RowRun<const float> run = rows.face(f, j);
        if (run.count == 0) break;
        forward(run, beside_row(quad, n, j, closed).at, moment.data());
        put(p, run.count, moment.data());
        p += run.count;
      }
    }
  });
}

// out <- R^T y on the unknowns; y has three interleaved numbers a point.
template <class T>
void apply_transposed(const RingRows& rows, const Unknowns& unknowns, Workers& workers,
                      Exchange<T, 1>& exchange, const T* y, T* out);

// out <- R^T R x on the unknowns.
template <class T>
void apply_square(const RingRows& rows, const Unknowns& unknowns, Workers& workers, Exchange<T, 1>& exchange,
                  const T* x, T* out);

// out <- the diagonal of R^T D R on the unknowns, where D has the number weight[p], the same for a point's three rows; no
// weights: one.
void square_diagonal(const RingRows& rows, const Unknowns& unknowns, Workers& workers,
                     Exchange<float, 1>& exchange, const float* weight, float* out);

// Calls visit(p, run, i, points) for every point p, which is point i of its run; points[s] is slot s.
template <class Visit>
void visit_rows(const RingRows& rows, Visit&& visit) {
  const Lattice& lattice = rows.lattice();
  const ControlMesh& mesh = lattice.mesh();
  const int n = lattice.n();
  std::vector<Index> points;
  for (Index v = 0; v < mesh.vertex_count(); ++v) {
    points.assign(1, v);
    visit_ring(lattice, v, [&](Index p, std::size_t) { points.push_back(p); });
    visit(v, rows.vertex(v), std::size_t(0), points);
  }
  for (Index e = 0; e < Index(mesh.edges.size()) && n > 1; ++e) {
    const EdgeRingLanes ring(mesh, e);
    for (int k = 1; k < n; ++k) {
      points.assign(1, lattice.edge_point(e, k));
      append_ring(lattice, e, ring, k, points);
      visit(points[0], rows.edge(e), std::size_t(k - 1), points);
    }
  }
  for (Index f = 0; f < Index(mesh.faces.size()); ++f) {
    for (int j = 1; j < n; ++j) {
      const RowRun<const float> run = rows.face(f, j);
      for (std::size_t i = 0; i < run.count; ++i) {
        points.assign(1, lattice.face_point(f, int(i) + 1, j));
        append_ring(lattice, f, {int(i) + 1, j}, points);
        visit(points[0], run, i, points);
      }
    }
  }
}

}  // namespace fairing
