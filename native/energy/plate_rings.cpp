// SPDX-License-Identifier: GPL-3.0-or-later
#include "energy/plate_rings.h"

#include "lattice/ring.h"

namespace fairing {
namespace {

// One neighbour's three numbers; those of the centre are minus the sum of all.
using Column = std::array<double, 3>;

// J^T J, the centre first.
void put_gram(std::span<const Column> neighbours, double scale, double* gram) {
  const std::size_t size = neighbours.size() + 1;
  Column centre = {};
  for (const Column& column : neighbours)
    for (std::size_t c = 0; c < 3; ++c) centre[c] -= column[c];
  const auto at = [&](std::size_t s) -> const Column& { return s == 0 ? centre : neighbours[s - 1]; };
  for (std::size_t s = 0; s < size; ++s)
    for (std::size_t m = 0; m < size; ++m)
      gram[s * size + m] = scale * (at(s)[0] * at(m)[0] + at(s)[1] * at(m)[1] + at(s)[2] * at(m)[2]);
}

}  // namespace

PlateRings::PlateRings(const Lattice& lattice, const Stencils& stencils, const Unknowns& unknowns,
                       Workers& workers)
    : lattice_(lattice), joint_(lattice), rings_(lattice, unknowns, workers) {
  write_grams(stencils);
  if (!lattice.mesh().region.whole()) write_weights();
}

void PlateRings::write_grams(const Stencils& s) {
  const ControlMesh& mesh = lattice_.mesh();
  const double scale = double(lattice_.n()) * lattice_.n();
  std::vector<Column> neighbours;
  const auto put = [&](bool fit) {
    gram_begin_.push_back(fit ? gram_.size() : none);
    if (!fit) return;
    gram_.resize(gram_.size() + (neighbours.size() + 1) * (neighbours.size() + 1));
    put_gram(neighbours, scale, gram_.data() + gram_begin_.back());
    neighbours.clear();
  };
  for (std::size_t v = 0; v < std::size_t(mesh.vertex_count()); ++v) {
    if (s.vertex_fit[v])
      for (auto k = std::size_t(s.ring_offset[v]); k < std::size_t(s.ring_offset[v + 1]); ++k) {
        const double* row = s.vertex_energy.data() + 3 * k;
        neighbours.push_back({row[0], row[1], row[2]});
      }
    put(s.vertex_fit[v]);
  }
  for (std::size_t e = 0; e < mesh.edges.size(); ++e) {
    const double* row = s.edge_energy.data() + 24 * e;
    for (std::size_t j = 0; s.edge_fit[e] && j < s.edge_ring[e]; ++j)
      neighbours.push_back({row[j], row[8 + j], row[16 + j]});
    put(s.edge_fit[e]);
  }
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    const std::size_t size = face_ring(mesh.faces[f].quad()).size();
    const double* g = s.face_energy.data() + 12 * f;
    for (std::size_t k = 0; s.face_fit[f] && k < size; ++k) {
      const std::size_t a = k % (size / 2);
      neighbours.push_back({g[a], g[4 + a], g[8 + a]});
    }
    put(s.face_fit[f]);
  }
}

void PlateRings::write_weights() {
  const ControlMesh& mesh = lattice_.mesh();
  const int n = lattice_.n();
  weight_.assign(lattice_.size(), 1.0);
  const auto put = [&](Index p, double weight) { weight_[std::size_t(p)] = weight; };
  for (Index v = 0; v < mesh.vertex_count(); ++v) put(v, joint_.vertex(v));
  for (Index e = 0; e < Index(mesh.edges.size()); ++e)
    for (int k = 1; k < n && joint_.weighs_edge(e); ++k)
      put(lattice_.edge_point(e, k), joint_.edge_point(e, k));
  for (Index f = 0; f < Index(mesh.faces.size()); ++f) {
    const bool quad = mesh.faces[std::size_t(f)].quad();
    for (int j = 1; j < n && joint_.weighs_face(f); ++j)
      for (int i = 1; i < (quad ? n : n - j); ++i)
        put(lattice_.face_point(f, i, j), joint_.face_point(f, i, j));
  }
}

}  // namespace fairing
