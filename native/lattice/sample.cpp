// SPDX-License-Identifier: GPL-3.0-or-later
#include "lattice/sample.h"

#include <algorithm>

#include "lattice/accumulate.h"

namespace fairing {

template <int C, class T>
void sample(const Lattice& coarse, const Lattice& fine, Workers& workers, const T* x, T* y) {
  const ControlMesh& mesh = coarse.mesh();
  const int n = coarse.n();
  const auto at = [](Index p) { return std::ptrdiff_t(C) * p; };
  std::copy_n(x, at(mesh.vertex_count()), y);
  workers.for_parts(mesh.edges.size(), element_grain(n) * std::size_t(n),
                    [&](std::size_t begin, std::size_t end) {
                      for (Index e = Index(begin); e < Index(end); ++e)
                        for (int k = 1; k < n; ++k)
                          copy_point<C>(y + at(coarse.edge_point(e, k)), x + at(fine.edge_point(e, 2 * k)));
                    });
  workers.for_parts(mesh.faces.size(), element_grain(n), [&](std::size_t begin, std::size_t end) {
    for (Index f = Index(begin); f < Index(end); ++f) {
      const bool quad = mesh.faces[std::size_t(f)].quad();
      T* to = y + at(coarse.face_base(f));
      for (int j = 1; j < n; ++j) {
        const T* row =
            x + at(fine.face_base(f)) +
            std::ptrdiff_t(C) * std::ptrdiff_t(interior_row(quad, std::size_t(fine.n()), std::size_t(2 * j)));
        for (int i = 1; i < (quad ? n : n - j); ++i, to += C) copy_point<C>(to, row + C * (2 * i - 1));
      }
    }
  });
}

template void sample<1, float>(const Lattice&, const Lattice&, Workers&, const float*, float*);
template void sample<3, double>(const Lattice&, const Lattice&, Workers&, const double*, double*);

}  // namespace fairing
