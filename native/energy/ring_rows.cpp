// SPDX-License-Identifier: GPL-3.0-or-later
#include "energy/ring_rows.h"

#include "execution/cancel.h"

namespace fairing {

RingRows::RingRows(const Lattice& lattice) : lattice_(&lattice) {
  const ControlMesh& mesh = lattice.mesh();
  const std::size_t n = std::size_t(lattice.n());
  std::size_t offset = 0;
  for (Index v = 0; v < mesh.vertex_count(); ++v) {
    stop_if_cancelled(std::size_t(v));
    vertex_offset_.push_back(offset);
    std::size_t slots = 1;
    visit_ring(lattice, v, [&](Index, std::size_t) { ++slots; });
    offset += 3 * slots;
  }
  vertex_offset_.push_back(offset);
  for (std::size_t e = 0; e < mesh.edges.size(); ++e) {
    stop_if_cancelled(e);
    edge_offset_.push_back(offset);
    offset += 3 * std::size_t(1 + EdgeRingLanes(mesh, Index(e)).size) * (n - 1);
  }
  edge_offset_.push_back(offset);
  for (const Face& face : mesh.faces) {
    face_offset_.push_back(offset);
    offset += 3 * (1 + face_ring(face.quad()).size()) * std::size_t(interior_size(face.quad(), lattice.n()));
  }
  face_offset_.push_back(offset);
  data_.resize(offset);
  fill_long(data_.data(), offset, 0.0f);
}

RowRun<float> RingRows::face(Index f, int j) {
  const bool quad = lattice_->mesh().faces[std::size_t(f)].quad();
  const int slots = 1 + int(face_ring(quad).size());
  const std::size_t before = interior_row(quad, std::size_t(lattice_->n()), std::size_t(j));
  return {row_count(quad, lattice_->n(), j), slots,
          data_.data() + face_offset_[std::size_t(f)] + std::size_t(3 * slots) * before};
}

}  // namespace fairing
