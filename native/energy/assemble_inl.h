// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cmath>

#include "energy/joint_weight.h"
#include "lattice/ring.h"

namespace fairing {

template <class Visit>
void visit_stencils(const Lattice& lattice, const Stencils& st, Visit&& visit) {
  const ControlMesh& mesh = lattice.mesh();
  const int n = lattice.n();
  const JointWeight joint(lattice);
  WrittenStencil out;
  double scale = n;
  const auto begin = [&](Index centre, double weight) {
    scale = n * std::sqrt(weight);
    out.points.assign(1, centre);
    out.column.assign(1, {0, 0, 0});
  };
  const auto add = [&](Index point, double r0, double r1, double r2) {
    out.points.push_back(point);
    out.column.push_back({scale * r0, scale * r1, scale * r2});
    for (std::size_t c = 0; c < 3; ++c) out.column[0][c] -= out.column.back()[c];
  };

  for (Index v = 0; v < mesh.vertex_count(); ++v) {
    if (!st.vertex_fit[std::size_t(v)]) continue;
    const double* row = st.vertex_energy.data() + 3 * std::size_t(st.ring_offset[std::size_t(v)]);
    begin(v, joint.vertex(v));
    visit_ring(lattice, v, [&](Index point, std::size_t) {
      add(point, row[0], row[1], row[2]);
      row += 3;
    });
    visit(std::as_const(out));
  }

  for (std::size_t e = 0; e < mesh.edges.size() && n > 1; ++e) {
    if (!st.edge_fit[e]) continue;
    const EdgeRingLanes ring(mesh, Index(e));
    const double* row = st.edge_energy.data() + 24 * e;
    const auto lane_point = [&](int lane, int k) {
      if (lane == 0) return lattice.edge_point(Index(e), k);
      const Side& side = mesh.sides[std::size_t(mesh.edges[e].side[std::size_t(lane - 1)])];
      const bool quad = mesh.faces[std::size_t(side.face)].quad();
      const int along = side.reversed ? row_size(quad, n) - 1 - k : k;
      return lattice.face_point(side.face, closed_point(quad, n, side.local, along, 1));
    };
    for (int k = 1; k < n; ++k) {
      begin(lattice.edge_point(Index(e), k), joint.edge_point(Index(e), k));
      for (int j = 0; j < ring.size; ++j)
        add(lane_point(ring.lane[j], ring.at[j] + k), row[j], row[8 + j], row[16 + j]);
      visit(std::as_const(out));
    }
  }

  const LatticePoint steps[2][4] = {{{1, 0}, {0, 1}, {-1, 1}, {0, 0}}, {{1, 0}, {1, 1}, {0, 1}, {-1, 1}}};
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    if (!st.face_fit[f]) continue;
    const bool quad = mesh.faces[f].quad();
    const double* g = st.face_energy.data() + 12 * f;
    for (int j = 1; j < n; ++j)
      for (int i = 1; i < (quad ? n : n - j); ++i) {
        begin(lattice.face_point(Index(f), i, j), joint.face_point(Index(f), i, j));
        for (int a = 0; a < (quad ? 4 : 3); ++a) {
          const LatticePoint d = steps[quad][a];
          add(lattice.face_point(Index(f), i + d.i, j + d.j), g[a], g[4 + a], g[8 + a]);
          add(lattice.face_point(Index(f), i - d.i, j - d.j), g[a], g[4 + a], g[8 + a]);
        }
        visit(std::as_const(out));
      }
  }
}

}  // namespace fairing
