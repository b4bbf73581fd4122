// SPDX-License-Identifier: GPL-3.0-or-later
#include "fair/grow.h"

#include "energy/ring_rows.h"

namespace fairing {

void grow(const Lattice& lattice, Workers& workers, Exchange<float, 1>& exchange, const Unknowns* unknowns,
          Array<float>& marks) {
  const ControlMesh& mesh = lattice.mesh();
  const int n = lattice.n();
  Array<float> out(marks.size());
  const auto vertex_body = [&](Index v, float* centre, float* spokes, std::vector<float>&) {
    if (!(marks[std::size_t(v)] > 0)) return;
    *centre += 1;
    visit_ring(lattice, v, [&](Index, std::size_t slot) { spokes[slot] += 1; });
  };
  const auto edge_body = [&](Index e, float* run, float* left, float* right, std::vector<float>&) {
    clear_lanes<1>(n, run, left, right);
    if (n == 1) return;
    float* const lanes[3] = {run, left, right};
    const EdgeRingLanes ring(mesh, e);
    const Beside<float> target = beside_edge(ring, lanes);
    const float* mark = marks.data() + lattice.edge_base(e);
    for (int i = 0; i < n - 1; ++i)
      for (int s = 0; s <= ring.size; ++s) target.at[s][i] += mark[i];
  };
  const auto face_body = [&](Index f, float* closed, std::vector<float>&) {
    const bool quad = mesh.faces[std::size_t(f)].quad();
    std::fill_n(closed, closed_size(quad, std::size_t(n)), 0.0f);
    const float* mark = marks.data() + lattice.face_base(f);
    const int slots = 1 + int(face_ring(quad).size());
    for (int j = 1; j < n; ++j) {
      const std::size_t count = row_count(quad, n, j);
      const Beside<float> target = beside_row(quad, n, j, closed);
      for (int s = 0; s < slots; ++s)
        for (std::size_t i = 0; i < count; ++i) target.at[s][i] += mark[i];
      mark += count;
    }
  };
  accumulate(lattice, workers, exchange, unknowns, out.data(), vertex_body, edge_body, face_body);
  marks.swap(out);
}

}  // namespace fairing
