// SPDX-License-Identifier: GPL-3.0-or-later
#include "fairing/weld.h"

#include <algorithm>

namespace fairing {

Weld::Weld(const GridLevel& grid) : grid_(grid) {
  const ControlMesh& mesh = grid.mesh();
  first_copy_ = mesh.input_vertices;
  first_centre_ = mesh.first_centre();
  first_edge_copy_ = grid.edge_base(mesh.first_copied_edge());
  first_face_ = grid.edge_base(Index(mesh.edges.size()));
  copies_ = first_centre_ - first_copy_;
  edge_copies_ = first_face_ - first_edge_copy_;
}

Index Weld::operator()(Index p) const {
  if (p < first_copy_) return p;
  if (p < first_centre_) return grid_.mesh().original_vertex(p);
  if (p < first_edge_copy_) return p - copies_;
  if (p >= first_face_) return p - copies_ - edge_copies_;
  const Index inner = grid_.n() - 1, along = p - first_edge_copy_;
  const Index e = grid_.mesh().original_edge(grid_.mesh().first_copied_edge() + along / inner);
  return grid_.edge_base(e) + along % inner - copies_;
}

void Weld::join(const double* points, double* out) const {
  const auto move = [&](Index begin, Index end, Index to) {
    std::copy(points + 3 * std::size_t(begin), points + 3 * std::size_t(end),
              out + 3 * std::size_t(to));
  };
  if (points != out) move(0, first_copy_, 0);
  move(first_centre_, first_edge_copy_, first_centre_ - copies_);
  move(first_face_, Index(grid_.size()), first_face_ - copies_ - edge_copies_);
}

}  // namespace fairing
