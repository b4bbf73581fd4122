// SPDX-License-Identifier: GPL-3.0-or-later
#include "transfer/written_transfer.h"

#include "lattice/ring.h"
#include "rows/limits.h"

namespace fairing {
namespace {

// What a fit's value half-way to a neighbour counts for: half of an edge's midpoint, a quarter of a quad's centre.
constexpr double of_midpoint = 0.5, of_centre = 0.25;
// The parabola through three points in a row, half-way.
constexpr double ahead = 0.375, behind = -0.125;

class HalfWay {
 public:
  HalfWay(const Lattice& coarse, const Stencils& stencils, const Unknowns& unknowns, Workers& workers)
      : mesh_(coarse.mesh()),
        stencils_(stencils),
        vertices_(coarse.mesh().vertex_count()),
        edges_(Index(coarse.mesh().edges.size())),
        rings_(coarse, unknowns, workers) {}

  const WrittenRings& rings() const { return rings_; }

  // Adds `share` of the fit about p, half-way to its neighbour q.
  void add(Index p, Index q, double share, RowBuilder& row) const {
    const WrittenRings::Ring& ring = rings_.about(p);
    const std::size_t slot = rings_.slot(ring, q) - 1;  // among the neighbours
    if (ring.element < vertices_)
      about_vertex(ring, slot, share, row);
    else if (ring.element < vertices_ + edges_)
      about_edge(ring, slot, share, row);
    else
      inside(ring, slot, share, row);
  }

 private:
  // share times the centre's number and the differences' times `number(neighbour)`.
  template <class Number>
  void put(const WrittenRings::Ring& ring, double share, RowBuilder& row, Number&& number) const {
    const WrittenRings::Member* members = rings_.members(ring);
    double own = 1;
    for (std::size_t m = 0; m + 1 < ring.size; ++m) {
      const double b = number(m);
      own -= b;
      if (b != 0 && members[m + 1] >= 0) row.add(members[m + 1], share * b);
    }
    if (members[0] >= 0) row.add(members[0], share * own);
  }

  void about_vertex(const WrittenRings::Ring& ring, std::size_t slot, double share, RowBuilder& row) const {
    const auto v = std::size_t(ring.element);
    if (!stencils_.vertex_fit[v]) return linear_about_vertex(ring, slot, share, row);
    const std::size_t first = 5 * std::size_t(stencils_.ring_offset[v]);
    const float* half = stencils_.vertex_half.data() + first + 5 * slot;
    const float* rows = stencils_.vertex_rows.data() + first;
    put(ring, share, row, [&](std::size_t m) {
      double sum = 0;
      for (std::size_t c = 0; c < 5; ++c) sum += double(half[c]) * rows[5 * m + c];
      return sum;
    });
  }

  // Half-way along a spoke the mean of its ends, across a quad that of its four corners.
  void linear_about_vertex(const WrittenRings::Ring& ring, std::size_t slot, double share,
                           RowBuilder& row) const {
    const auto spokes = mesh_.ring(ring.element);
    std::size_t at = 0;  // the place of a spoke's neighbour
    for (std::size_t k = 0; k < spokes.size(); ++k) {
      const bool quad = spokes[k].face >= 0 && mesh_.faces[std::size_t(spokes[k].face)].quad();
      if (slot == at) return put(ring, share, row, [&](std::size_t m) { return m == at ? 0.5 : 0.0; });
      if (quad && slot == at + 1) {
        const std::size_t next = k + 1 < spokes.size() ? at + 2 : 0;
        return put(ring, share, row,
                   [&](std::size_t m) { return m == at || m == at + 1 || m == next ? 0.25 : 0.0; });
      }
      at += quad ? 2 : 1;
    }
  }

  void about_edge(const WrittenRings::Ring& ring, std::size_t slot, double share, RowBuilder& row) const {
    const float* half = stencils_.edge_half.data() + 64 * std::size_t(ring.element - vertices_) + 8 * slot;
    put(ring, share, row, [&](std::size_t m) { return double(half[m]); });
  }

  void inside(const WrittenRings::Ring& ring, std::size_t slot, double share, RowBuilder& row) const {
    const std::size_t count = ring.size - 1, opposite = (slot + count / 2) % count;
    put(ring, share, row, [&](std::size_t m) { return m == slot ? ahead : m == opposite ? behind : 0.0; });
  }

  const ControlMesh& mesh_;
  const Stencils& stencils_;
  Index vertices_, edges_;
  WrittenRings rings_;
};

// Rows of the prolongation for the points of the fine level.
class FineRows {
 public:
  FineRows(const Lattice& coarse, const Lattice& fine, const HalfWay& half)
      : coarse_(coarse), fine_(fine), half_(half) {}

  void write(Index p, RowBuilder& row) const {
    const ControlMesh& mesh = fine_.mesh();
    const int n = fine_.n();
    const Index vertices = mesh.vertex_count(), first_in_faces = fine_.face_base(0);
    if (p < vertices) return row.add(p, 1);
    if (p < first_in_faces) {
      const Index e = (p - vertices) / (n - 1), k = (p - vertices) % (n - 1) + 1;
      return between(coarse_.edge_point(e, k / 2), coarse_.edge_point(e, (k + 1) / 2), of_midpoint, row);
    }
    const Index f = face_of(p);
    const bool quad = mesh.faces[std::size_t(f)].quad();
    const LatticePoint at = place_in(quad, n, p - fine_.face_base(f));
    const auto corner = [&](int i, int j) { return coarse_.face_point(f, (at.i + i) / 2, (at.j + j) / 2); };
    const bool odd_i = at.i % 2, odd_j = at.j % 2;
    if (odd_i && odd_j && quad) {
      between(corner(-1, -1), corner(1, 1), of_centre, row);
      between(corner(1, -1), corner(-1, 1), of_centre, row);
    } else if (odd_i && odd_j) {
      between(corner(1, -1), corner(-1, 1), of_midpoint, row);
    } else {
      between(corner(odd_i ? -1 : 0, odd_j ? -1 : 0), corner(odd_i ? 1 : 0, odd_j ? 1 : 0), of_midpoint, row);
    }
  }

 private:
  void between(Index a, Index b, double share, RowBuilder& row) const {
    if (a == b) {
      if (half_.rings().is_unknown(a)) row.add(a, 1);
      return;
    }
    half_.add(a, b, share, row);
    half_.add(b, a, share, row);
  }

  Index face_of(Index p) const {
    Index low = 0, high = Index(fine_.mesh().faces.size());
    while (high - low > 1) {
      const Index middle = low + (high - low) / 2;
      (fine_.face_base(middle) <= p ? low : high) = middle;
    }
    return low;
  }

  static LatticePoint place_in(bool quad, int n, Index inside) {
    int j = 1;
    while (j + 1 < n && std::size_t(inside) >= interior_row(quad, std::size_t(n), std::size_t(j + 1))) ++j;
    return {int(inside - Index(interior_row(quad, std::size_t(n), std::size_t(j)))) + 1, j};
  }

  const Lattice &coarse_, &fine_;
  const HalfWay& half_;
};

}  // namespace

bool WrittenTransfer::suits(const Lattice& fine) { return has_rows(fine.n(), fine.size()); }

WrittenTransfer::WrittenTransfer(const Lattice& coarse, const Lattice& fine, const Stencils& stencils,
                                 const Unknowns& unknowns, Workers& workers)
    : prolongation_(fine.size(), coarse.size()), restriction_(coarse.size(), fine.size()) {
  const HalfWay half(coarse, stencils, unknowns, workers);
  const FineRows rows(coarse, fine, half);
  const std::vector<std::uint8_t> unknown = unknown_points(fine, unknowns);
  prolongation_.build(workers, [&](Index p, RowBuilder& row) {
    if (unknown[std::size_t(p)]) rows.write(p, row);
  });
  const WrittenMatrix::Columns columns = prolongation_.by_columns();
  restriction_.build(workers, [&](Index p, RowBuilder& row) {
    for (std::size_t k = columns.first[std::size_t(p)]; k < columns.first[std::size_t(p) + 1]; ++k)
      row.add(columns.entry[k].first, double(columns.entry[k].second));
  });
}

}  // namespace fairing
