// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/ring_shape.h"

namespace fairing {

void RingShape::set(const GridLevel& grid, const Run& run) {
  far.clear();
  first = 0;
  closed = true;
  switch (run.kind) {
    case RunKind::vertex:
      visit_ring(grid, run.element, [&](Index, std::size_t slot) { far.push_back(slot % 2 == 1); });
      closed = grid.mesh().interior(run.element);
      return;
    case RunKind::edge: {
      const Edge& edge = grid.mesh().edges[run.element];
      far.assign(run.ring->far, run.ring->far + run.ring->size);
      closed = !edge.boundary();
      first = edge.side[0] < 0 ? 1 : 0;  // without a left face: after it
      return;
    }
    case RunKind::face_row:
      for (const GridPoint d : face_ring(run.quad)) far.push_back(is_far(run.quad, d));
  }
}

}  // namespace fairing
