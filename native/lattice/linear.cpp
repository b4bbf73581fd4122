// SPDX-License-Identifier: GPL-3.0-or-later
#include "lattice/linear.h"

#include "execution/cancel.h"
#include "execution/vectors.h"
#include "lattice/accumulate.h"

namespace fairing {
namespace {

double* put(const Vec3& p, double* x) {
  for (int a = 0; a < 3; ++a) *x++ = p[a];
  return x;
}

void refine_edge(const Lattice& lattice, std::span<const Vec3> control, Index e, double* x) {
  const Edge& edge = lattice.mesh().edges[std::size_t(e)];
  const int n = lattice.n();
  const Vec3 &a = control[std::size_t(edge.vertex[0])], &b = control[std::size_t(edge.vertex[1])];
  x += 3 * std::size_t(lattice.edge_base(e));
  for (int k = 1; k < n; ++k) x = put((double(n - k) * a + double(k) * b) / n, x);
}

void refine_face(const Lattice& lattice, std::span<const Vec3> control, Index f, double* x) {
  const Face& face = lattice.mesh().faces[std::size_t(f)];
  const int n = lattice.n();
  const auto corner = [&](std::size_t c) -> const Vec3& { return control[std::size_t(face.vertex[c])]; };
  x += 3 * std::size_t(lattice.face_base(f));
  for (int j = 1; j < n; ++j) {
    stop_in_large_face(j);
    if (face.quad()) {
      const Vec3 left = (double(n - j) * corner(0) + double(j) * corner(3)) / n,
                 right = (double(n - j) * corner(1) + double(j) * corner(2)) / n;
      for (int i = 1; i < n; ++i) x = put((double(n - i) * left + double(i) * right) / n, x);
    } else {
      for (int i = 1; i < n - j; ++i)
        x = put((double(n - i - j) * corner(0) + double(i) * corner(1) + double(j) * corner(2)) / n, x);
    }
  }
}

}  // namespace

void refine_linearly(const Lattice& lattice, std::span<const Vec3> control, Workers& workers, double* x) {
  const ControlMesh& mesh = lattice.mesh();
  const std::size_t n = std::size_t(lattice.n());
  for_each_index(workers, control.size(), [&](std::size_t v) { put(control[v], x + 3 * v); });
  workers.for_parts(mesh.edges.size(), element_grain(lattice.n()) * n,
                    [&](std::size_t begin, std::size_t end) {
                      for (std::size_t e = begin; e < end; ++e) refine_edge(lattice, control, Index(e), x);
                    });
  workers.for_parts(mesh.faces.size(), element_grain(lattice.n()), [&](std::size_t begin, std::size_t end) {
    for (std::size_t f = begin; f < end; ++f) refine_face(lattice, control, Index(f), x);
  });
}

void refine_linearly(const Lattice& lattice, std::span<const Vec3> control, double* x) {
  const ControlMesh& mesh = lattice.mesh();
  for (std::size_t v = 0; v < control.size(); ++v) put(control[v], x + 3 * v);
  for (std::size_t e = 0; e < mesh.edges.size(); ++e) refine_edge(lattice, control, Index(e), x);
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) refine_face(lattice, control, Index(f), x);
}

void refine_outside_linearly(const Lattice& lattice, std::span<const Vec3> control, double* x) {
  const ControlMesh& mesh = lattice.mesh();
  if (mesh.region.whole()) return;
  for (std::size_t e = 0; e < mesh.edges.size(); ++e) {
    stop_if_cancelled(e);
    if (mesh.edge_place(Index(e)) != Place::inside) refine_edge(lattice, control, Index(e), x);
  }
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    stop_if_cancelled(f);
    if (mesh.face_place(Index(f)) != Place::inside) refine_face(lattice, control, Index(f), x);
  }
}

}  // namespace fairing
