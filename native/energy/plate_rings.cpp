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

std::size_t ring_length(const ControlMesh& mesh, Index v) {
  std::size_t length = 0;
  for (const Spoke& spoke : mesh.ring(v))
    length += spoke.face >= 0 && mesh.faces[std::size_t(spoke.face)].quad() ? 2 : 1;
  return length;
}

constexpr std::size_t ring_length_in(bool quad) { return quad ? 8 : 6; }

// Calls visit(i, j) for the points inside a face, row by row.
template <class Visit>
void visit_inside(bool quad, int n, Visit&& visit) {
  for (int j = 1; j < n; ++j)
    for (int i = 1; i < (quad ? n : n - j); ++i) visit(i, j);
}

// So many of them are at most `steps` from a side.
std::size_t count_near(bool quad, int n, int steps) {
  const std::int64_t inner = quad ? n - 2 * steps : n - 3 * steps;
  return std::size_t(interior_size(quad, n) - (inner > 1 ? interior_size(quad, inner) : 0));
}

}  // namespace

PlateRings::PlateRings(const Lattice& lattice, const Stencils& stencils, const Unknowns& unknowns, int steps,
                       Workers& workers)
    : lattice_(lattice),
      joint_(lattice),
      first_in_faces_(std::size_t(lattice.mesh().vertex_count()) +
                      lattice.mesh().edges.size() * std::size_t(lattice.n() - 1)) {
  code_points(unknowns);
  write_vertices(stencils);
  write_edges(stencils, workers);
  write_faces(stencils, steps, workers);
}

void PlateRings::code_points(const Unknowns& unknowns) {
  const ControlMesh& mesh = lattice_.mesh();
  coded_.resize(lattice_.size());
  Index p = 0;
  const auto code = [&](std::int64_t count, bool unknown) {
    for (const Index end = p + Index(count); p < end; ++p) coded_[std::size_t(p)] = unknown ? p : ~p;
  };
  for (Index v = 0; v < mesh.vertex_count(); ++v) code(1, unknowns.vertex[std::size_t(v)]);
  for (std::size_t e = 0; e < mesh.edges.size(); ++e) code(lattice_.n() - 1, unknowns.edge[e]);
  for (std::size_t f = 0; f < mesh.faces.size(); ++f)
    code(interior_size(mesh.faces[f].quad(), lattice_.n()), unknowns.has_face(f));
}

void PlateRings::write_vertices(const Stencils& s) {
  const ControlMesh& mesh = lattice_.mesh();
  const double scale = double(lattice_.n()) * lattice_.n();
  std::size_t members = 0, grams = 0;
  for (Index v = 0; v < mesh.vertex_count(); ++v) {
    const std::size_t size = s.vertex_fit[std::size_t(v)] ? ring_length(mesh, v) + 1 : 0;
    ring_.push_back({members, grams, std::uint32_t(size), float(joint_.vertex(v))});
    members += size;
    grams += size * size;
  }
  member_.resize(members);
  gram_.resize(grams);
  std::vector<Column> neighbours;
  for (Index v = 0; v < mesh.vertex_count(); ++v) {
    const Ring& ring = ring_[std::size_t(v)];
    if (ring.size == 0) continue;
    Member* to = member_.data() + ring.member;
    *to++ = coded_[std::size_t(v)];
    visit_ring(lattice_, v, [&](Index point, std::size_t) { *to++ = coded_[std::size_t(point)]; });
    const double* row = s.vertex_energy.data() + 3 * std::size_t(s.ring_offset[std::size_t(v)]);
    neighbours.clear();
    for (std::size_t k = 0; k + 1 < ring.size; ++k, row += 3) neighbours.push_back({row[0], row[1], row[2]});
    put_gram(neighbours, scale, gram_.data() + ring.gram);
  }
}

void PlateRings::write_edges(const Stencils& s, Workers& workers) {
  const ControlMesh& mesh = lattice_.mesh();
  const int n = lattice_.n();
  if (n == 1) return;
  const double scale = double(n) * n;
  const std::size_t first_ring = ring_.size();
  std::size_t members = member_.size(), grams = gram_.size();
  for (std::size_t e = 0; e < mesh.edges.size(); ++e) {
    const std::size_t size = s.edge_fit[e] ? s.edge_ring[e] + std::size_t(1) : 0;
    for (int k = 1; k < n; ++k, members += size)
      ring_.push_back({members, grams, std::uint32_t(size), float(joint_.edge_point(Index(e), k))});
    grams += size * size;
  }
  member_.resize(members);
  gram_.resize(grams);
  workers.for_parts(mesh.edges.size(), element_grain(n) * std::size_t(n),
                    [&](std::size_t begin, std::size_t end) {
                      std::vector<Member> scratch;
                      std::vector<Column> neighbours;
                      for (std::size_t e = begin; e < end; ++e) {
                        const Ring& first = ring_[first_ring + e * std::size_t(n - 1)];
                        if (first.size == 0) continue;
                        const EdgeRingLanes ring(mesh, Index(e));
                        const EdgeLanes<Member, 1> lanes(lattice_, coded_.data(), Index(e), scratch);
                        Member* to = member_.data() + first.member;
                        for (int k = 1; k < n; ++k) {
                          *to++ = lanes.lane[0][k];
                          for (int j = 0; j < ring.size; ++j)
                            *to++ = lanes.lane[ring.lane[j]][ring.at[j] + k];
                        }
                        const double* row = s.edge_energy.data() + 24 * e;
                        neighbours.clear();
                        for (int j = 0; j < ring.size; ++j)
                          neighbours.push_back({row[j], row[8 + j], row[16 + j]});
                        put_gram(neighbours, scale, gram_.data() + first.gram);
                      }
                    });
}

void PlateRings::write_faces(const Stencils& s, int steps, Workers& workers) {
  const ControlMesh& mesh = lattice_.mesh();
  const int n = lattice_.n();
  const double scale = double(n) * n;
  struct First {
    std::size_t ring, member, gram;
  };
  std::vector<First> first;
  First next{ring_.size(), member_.size(), gram_.size()};
  const auto near = [&](std::size_t f) { return joint_.weighs_face(Index(f)) ? n : steps; };
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    first.push_back(next);
    if (!s.face_fit[f]) continue;
    const bool quad = mesh.faces[f].quad();
    const std::size_t rings = count_near(quad, n, near(f)), size = ring_length_in(quad) + 1;
    next.ring += rings;
    next.member += rings * size;
    next.gram += size * size;
  }
  ring_.resize(next.ring);
  member_.resize(next.member);
  gram_.resize(next.gram);
  ring_of_.resize(lattice_.size() - first_in_faces_);
  workers.for_parts(mesh.faces.size(), element_grain(n), [&](std::size_t begin, std::size_t end) {
    std::vector<Member> closed(closed_size(true, std::size_t(n)));
    std::vector<Column> neighbours;
    for (std::size_t f = begin; f < end; ++f) {
      const bool quad = mesh.faces[f].quad(), weighted = joint_.weighs_face(Index(f));
      Index* ring_of = ring_of_.data() + (std::size_t(lattice_.face_base(Index(f))) - first_in_faces_);
      if (!s.face_fit[f]) {
        std::fill(ring_of, ring_of + interior_size(quad, n), Index(-1));
        continue;
      }
      gather_face<1>(lattice_, coded_.data(), Index(f), closed.data());
      const auto at = [&](int i, int j) {
        return closed[closed_row(quad, std::size_t(n), std::size_t(j)) + std::size_t(i)];
      };
      First put = first[f];
      const std::size_t size = ring_length_in(quad) + 1;
      visit_inside(quad, n, [&](int i, int j) {
        const bool written = steps_to_side(quad, n, i, j) <= near(f);
        *ring_of++ = written ? Index(put.ring) : Index(-1);
        if (!written) return;
        const double weight = weighted ? joint_.face_point(Index(f), i, j) : 1.0;
        ring_[put.ring++] = {put.member, put.gram, std::uint32_t(size), float(weight)};
        member_[put.member++] = at(i, j);
        for (const LatticePoint d : face_ring(quad)) member_[put.member++] = at(i + d.i, j + d.j);
      });
      const double* g = s.face_energy.data() + 12 * f;
      neighbours.clear();
      for (std::size_t k = 0; k + 1 < size; ++k) {
        const std::size_t a = k % (quad ? 4 : 3);
        neighbours.push_back({g[a], g[4 + a], g[8 + a]});
      }
      put_gram(neighbours, scale, gram_.data() + put.gram);
    }
  });
}

}  // namespace fairing
