// SPDX-License-Identifier: GPL-3.0-or-later
#include "lattice/mirror.h"

namespace fairing {
namespace {

LatticePoint corner(bool quad, int n, int c) {
  switch (c) {
    case 0: return {0, 0};
    case 1: return {n, 0};
    case 2: return quad ? LatticePoint{n, n} : LatticePoint{0, n};
    default: return {0, n};
  }
}

// Every pair of points is written once, with the element of the smaller number.
template <class Write>
class Pairs {
 public:
  Pairs(const Lattice& lattice, const Mirror& mirror, const Unknowns& unknowns, const Write& write)
      : lattice_(lattice), mirror_(mirror), unknowns_(unknowns), write_(write) {}

  void vertex(Index v) const {
    if (unknowns_.vertex[std::size_t(v)]) pair(v, mirror_.vertex[std::size_t(v)]);
  }

  void edge(Index e) const {
    const Index image = mirror_.edge[std::size_t(e)];
    if (image < e || !unknowns_.edge[std::size_t(e)]) return;
    const int n = lattice_.n();
    const bool reversed = mirror_.reverses(lattice_.mesh(), e);
    for (int k = 1; k < n; ++k)
      pair(lattice_.edge_point(e, k), lattice_.edge_point(image, reversed ? n - k : k));
  }

  void face(Index f) const {
    const Index image = mirror_.face[std::size_t(f)];
    if (image < f || !unknowns_.has_face(std::size_t(f))) return;
    const int n = lattice_.n();
    const bool quad = lattice_.mesh().faces[std::size_t(f)].quad();
    const FaceImage map = face_image(quad, n, mirror_.turn[std::size_t(f)]);
    const Index base = lattice_.face_base(image);
    Index point = lattice_.face_base(f);
    for (int j = 1; j < n; ++j)
      for (int i = 1; i < (quad ? n : n - j); ++i) {
        const LatticePoint at = map.of(i, j);
        pair(point++, base + Index(interior_row(quad, std::size_t(n), std::size_t(at.j))) + at.i - 1);
      }
  }

 private:
  void pair(Index p, Index q) const {
    if (p <= q) write_(std::ptrdiff_t(p), std::ptrdiff_t(q));
  }

  const Lattice& lattice_;
  const Mirror& mirror_;
  const Unknowns& unknowns_;
  const Write& write_;
};

template <class Write>
void for_pairs(const Lattice& lattice, const Mirror& mirror, const Unknowns& unknowns, Workers& workers,
               const Write& write) {
  const ControlMesh& mesh = lattice.mesh();
  const Pairs pairs(lattice, mirror, unknowns, write);
  if (unknowns.any_vertex)
    for (Index v = 0; v < mesh.vertex_count(); ++v) pairs.vertex(v);
  workers.for_parts(mesh.edges.size(), element_grain(lattice.n()) * std::size_t(lattice.n()),
                    [&](std::size_t begin, std::size_t end) {
                      for (std::size_t e = begin; e < end; ++e) pairs.edge(Index(e));
                    });
  workers.for_parts(mesh.faces.size(), element_grain(lattice.n()), [&](std::size_t begin, std::size_t end) {
    for (std::size_t f = begin; f < end; ++f) pairs.face(Index(f));
  });
}

}  // namespace

FaceImage face_image(bool quad, int n, int turn) {
  const int size = quad ? 4 : 3;
  const auto image = [&](int c) { return corner(quad, n, (turn - c + size) % size); };
  const LatticePoint origin = image(0), along = image(1), across = image(size - 1);
  return {origin,
          {(along.i - origin.i) / n, (along.j - origin.j) / n},
          {(across.i - origin.i) / n, (across.j - origin.j) / n}};
}

void mean_with_image(const Lattice& lattice, const Mirror& mirror, const Unknowns& unknowns, Workers& workers,
                     double* x) {
  for_pairs(lattice, mirror, unknowns, workers, [&](std::ptrdiff_t p, std::ptrdiff_t q) {
    Eigen::Map<Vec3> a(x + 3 * p), b(x + 3 * q);
    const Vec3 mean = 0.5 * (a + mirror.plane.image(b));
    b = mirror.plane.image(mean);
    a = mean;
  });
}

void mean_of_displacements(const Lattice& lattice, const Mirror& mirror, const Unknowns& unknowns,
                           Workers& workers, double* h) {
  for_pairs(lattice, mirror, unknowns, workers,
            [&](std::ptrdiff_t p, std::ptrdiff_t q) { h[p] = h[q] = 0.5 * (h[p] + h[q]); });
}

}  // namespace fairing
