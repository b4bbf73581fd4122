// SPDX-License-Identifier: GPL-3.0-or-later
#include "rows/rings.h"

#include "control_mesh/ring_size.h"
#include "lattice/ring.h"

namespace fairing {

WrittenRings::WrittenRings(const Lattice& lattice, const Unknowns& unknowns, Workers& workers)
    : lattice_(lattice) {
  code_points(unknowns);
  write_vertices();
  write_edges(workers);
  write_faces(workers);
}

std::vector<std::uint8_t> unknown_points(const Lattice& lattice, const Unknowns& unknowns) {
  const ControlMesh& mesh = lattice.mesh();
  std::vector<std::uint8_t> out(lattice.size());
  auto to = out.begin();
  const auto put = [&](std::int64_t count, bool unknown) {
    to = std::fill_n(to, count, std::uint8_t(unknown));
  };
  for (Index v = 0; v < mesh.vertex_count(); ++v) put(1, unknowns.vertex[std::size_t(v)]);
  for (std::size_t e = 0; e < mesh.edges.size(); ++e) {
    stop_if_cancelled(e);
    put(lattice.n() - 1, unknowns.edge[e]);
  }
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    stop_if_cancelled(f);
    put(interior_size(mesh.faces[f].quad(), lattice.n()), unknowns.has_face(f));
  }
  return out;
}

void WrittenRings::code_points(const Unknowns& unknowns) {
  const std::vector<std::uint8_t> unknown = unknown_points(lattice_, unknowns);
  coded_.resize(unknown.size());
  for (std::size_t p = 0; p < unknown.size(); ++p) coded_[p] = unknown[p] ? Index(p) : ~Index(p);
}

void WrittenRings::write_vertices() {
  const ControlMesh& mesh = lattice_.mesh();
  for (Index v = 0; v < mesh.vertex_count(); ++v) {
    stop_if_cancelled(std::size_t(v));
    ring_.push_back({member_.size(), std::uint32_t(ring_size(mesh, v) + 1), v});
    member_.push_back(coded_[std::size_t(v)]);
    visit_ring(lattice_, v, [&](Index point, std::size_t) { member_.push_back(coded_[std::size_t(point)]); });
  }
}

void WrittenRings::write_edges(Workers& workers) {
  const ControlMesh& mesh = lattice_.mesh();
  const int n = lattice_.n();
  if (n == 1) return;
  const std::size_t first_ring = ring_.size();
  std::size_t members = member_.size();
  for (std::size_t e = 0; e < mesh.edges.size(); ++e) {
    stop_if_cancelled(e);
    const auto size = std::uint32_t(EdgeRingLanes(mesh, Index(e)).size + 1);
    for (int k = 1; k < n; ++k, members += size)
      ring_.push_back({members, size, mesh.vertex_count() + Index(e)});
  }
  member_.resize(members);
  workers.for_parts(mesh.edges.size(), element_grain(n) * std::size_t(n),
                    [&](std::size_t begin, std::size_t end) {
                      std::vector<Member> scratch;
                      for (std::size_t e = begin; e < end; ++e) {
                        const EdgeRingLanes ring(mesh, Index(e));
                        const EdgeLanes<Member, 1> lanes(lattice_, coded_.data(), Index(e), scratch);
                        Member* to = member_.data() + ring_[first_ring + e * std::size_t(n - 1)].member;
                        for (int k = 1; k < n; ++k) {
                          *to++ = lanes.lane[0][k];
                          for (int j = 0; j < ring.size; ++j)
                            *to++ = lanes.lane[ring.lane[j]][ring.at[j] + k];
                        }
                      }
                    });
}

void WrittenRings::write_faces(Workers& workers) {
  const ControlMesh& mesh = lattice_.mesh();
  const int n = lattice_.n();
  const Index first_face = mesh.vertex_count() + Index(mesh.edges.size());
  std::size_t members = member_.size();
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    stop_if_cancelled(f);
    const bool quad = mesh.faces[f].quad();
    const auto size = std::uint32_t(face_ring(quad).size() + 1);
    for (auto k = interior_size(quad, n); k > 0; --k, members += size)
      ring_.push_back({members, size, first_face + Index(f)});
  }
  member_.resize(members);
  workers.for_parts(mesh.faces.size(), element_grain(n), [&](std::size_t begin, std::size_t end) {
    std::vector<Member> closed(closed_size(true, std::size_t(n)));
    for (std::size_t f = begin; f < end; ++f) {
      const bool quad = mesh.faces[f].quad();
      if (interior_size(quad, n) == 0) continue;
      const std::span<const LatticePoint> neighbours = face_ring(quad);
      gather_face<1>(lattice_, coded_.data(), Index(f), closed.data());
      const auto at = [&](int i, int j) {
        return closed[closed_row(quad, std::size_t(n), std::size_t(j)) + std::size_t(i)];
      };
      Member* to = member_.data() + ring_[std::size_t(lattice_.face_base(Index(f)))].member;
      for (int j = 1; j < n; ++j)
        for (int i = 1; i < (quad ? n : n - j); ++i) {
          *to++ = at(i, j);
          for (const LatticePoint d : neighbours) *to++ = at(i + d.i, j + d.j);
        }
    }
  });
}

}  // namespace fairing
