// SPDX-License-Identifier: GPL-3.0-or-later
#include "fairing/joined_sheets.h"

#include <algorithm>

namespace fairing {
namespace {

// The first point inside a face; for the last face + 1, the number of points.
Index face_begin(const GridLevel& grid, Index f) {
  return f < Index(grid.mesh().faces.size()) ? grid.face_base(f) : Index(grid.size());
}

}  // namespace

JoinedSheets::JoinedSheets(const GridLevel& grid) : grid_(grid) {
  const ControlMesh& mesh = grid.mesh();
  vertices_ = {0, mesh.input_vertices, mesh.first_centre()};
  centres_ = {vertices_.end, mesh.first_copied_centre(), mesh.vertex_count()};
  edges_ = {centres_.end, grid.edge_base(mesh.first_copied_edge()),
            grid.edge_base(Index(mesh.edges.size()))};
  faces_ = {edges_.end, face_begin(grid, mesh.first_copied_face()), Index(grid.size())};
}

std::size_t JoinedSheets::size() const {
  std::size_t size = 0;
  for (const Block& block : {vertices_, centres_, edges_, faces_})
    size += std::size_t(block.copies - block.begin);
  return size;
}

Index JoinedSheets::operator()(Index p) const {
  const ControlMesh& mesh = grid_.mesh();
  Index before = 0;  // number of copies before p's block
  if (p < vertices_.end) return mesh.original_vertex(p);
  before += vertices_.end - vertices_.copies;
  if (p < centres_.end) return mesh.original_vertex(p) - before;
  before += centres_.end - centres_.copies;
  if (p < edges_.copies) return p - before;
  if (p < edges_.end) {
    const Index inner = grid_.n() - 1, along = p - edges_.copies;
    const Index e = mesh.original_edge(mesh.first_copied_edge() + along / inner);
    return grid_.edge_base(e) + along % inner - before;
  }
  return p - before - (edges_.end - edges_.copies);
}

void JoinedSheets::set_means(double* points) const {
  const ControlMesh& mesh = grid_.mesh();
  const auto mean = [&](Index original, Index copy) {
    for (std::size_t a = 0; a < 3; ++a) {
      double& first = points[3 * std::size_t(original) + a];
      first = 0.5 * first + 0.5 * points[3 * std::size_t(copy) + a];
    }
  };
  const auto mean_of_vertex = [&](Index v) {
    if (mesh.second_vertex(v)) mean(mesh.original_vertex(v), v);
  };
  for (Index v = mesh.input_vertices; v < mesh.first_centre(); ++v) mean_of_vertex(v);
  for (Index v = mesh.first_copied_centre(); v < mesh.vertex_count(); ++v) mean_of_vertex(v);
  for (Index e = mesh.first_copied_edge(); e < Index(mesh.edges.size()); ++e)
    for (int k = 1; k < grid_.n() && mesh.second_edge(e); ++k)
      mean(grid_.edge_point(mesh.original_edge(e), k), grid_.edge_point(e, k));
  const int n = grid_.n();
  for (Index f = mesh.first_copied_face(); f < Index(mesh.faces.size()); ++f) {
    const Index original = mesh.copies.face[f - mesh.first_copied_face()];
    const bool quad = mesh.faces[f].quad();
    for (int j = 1; j < n; ++j)
      for (int i = 1; i < (quad ? n : n - j); ++i)
        mean(grid_.face_point(original, i, j), grid_.face_point(f, j, i));
  }
}

void JoinedSheets::join(double* points, double* out) const {
  if (!grid_.mesh().copies.face.empty()) set_means(points);
  double* to = out;
  for (const Block& block : {vertices_, centres_, edges_, faces_}) {
    const double *begin = points + 3 * std::size_t(block.begin),
                 *end = points + 3 * std::size_t(block.copies);
    if (begin != to) std::copy(begin, end, to);
    to += end - begin;
  }
}

void JoinedSheets::join(Array<double>& points) const {
  if (!needed()) return;
  join(points.data(), points.data());
  points.resize(3 * size());
}

}  // namespace fairing
