// SPDX-License-Identifier: GPL-3.0-or-later
#include "lattice/linear.h"

namespace fairing {

void refine_linearly(const Lattice& lattice, std::span<const Vec3> control, double* x) {
  const ControlMesh& mesh = lattice.mesh();
  const int n = lattice.n();
  const auto put = [&](const Vec3& p) {
    for (int a = 0; a < 3; ++a) *x++ = p[a];
  };
  for (const Vec3& p : control) put(p);
  for (const Edge& edge : mesh.edges) {
    const Vec3 &a = control[std::size_t(edge.vertex[0])], &b = control[std::size_t(edge.vertex[1])];
    for (int k = 1; k < n; ++k) put((double(n - k) * a + double(k) * b) / n);
  }
  for (const Face& face : mesh.faces) {
    const auto corner = [&](std::size_t c) -> const Vec3& { return control[std::size_t(face.vertex[c])]; };
    for (int j = 1; j < n; ++j) {
      if (face.quad()) {
        const Vec3 left = (double(n - j) * corner(0) + double(j) * corner(3)) / n,
                   right = (double(n - j) * corner(1) + double(j) * corner(2)) / n;
        for (int i = 1; i < n; ++i) put((double(n - i) * left + double(i) * right) / n);
      } else {
        for (int i = 1; i < n - j; ++i)
          put((double(n - i - j) * corner(0) + double(i) * corner(1) + double(j) * corner(2)) / n);
      }
    }
  }
}

}  // namespace fairing
