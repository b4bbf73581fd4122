// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/grid_level.h"

namespace fairing {

std::int64_t grid_size(std::int64_t vertices, std::int64_t edges, std::int64_t triangles,
                       std::int64_t quads, int level) {
  const std::int64_t n = std::int64_t(1) << level;
  return vertices + edges * (n - 1) + triangles * interior_size(false, n) +
         quads * interior_size(true, n);
}

GridLevel::GridLevel(const ControlMesh& mesh, int level)
    : mesh_(&mesh), level_(level), n_(1 << level), vertices_(mesh.vertex_count()) {
  triangle_interior_ = interior_size(false, n_);
  quad_interior_ = interior_size(true, n_);
  first_face_ = vertices_ + std::int64_t(mesh.edges.size()) * (n_ - 1);
  quads_before_.reserve(mesh.faces.size());
  Index quads = 0;
  for (const Face& face : mesh.faces) {
    quads_before_.push_back(quads);
    quads += face.quad();
  }
  const auto triangles = std::int64_t(mesh.faces.size()) - quads;
  size_ = std::size_t(first_face_ + triangles * triangle_interior_ + quads * quad_interior_);
}

Index GridLevel::face_point(Index f, int i, int j) const {
  const Face& face = mesh_->faces[f];
  const auto side = [&](int s) -> const Side& { return mesh_->sides[face.first_side + s]; };
  if (j == 0) return side_point(side(0), i);
  if (face.quad()) {
    if (i == n_) return side_point(side(1), j);
    if (j == n_) return side_point(side(2), n_ - i);
    if (i == 0) return side_point(side(3), n_ - j);
  } else {
    if (i + j == n_) return side_point(side(1), j);
    if (i == 0) return side_point(side(2), n_ - j);
  }
  return face_base(f) + Index(interior_row(face.quad(), std::size_t(n_), std::size_t(j))) + i - 1;
}

}  // namespace fairing
