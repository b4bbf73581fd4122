// SPDX-License-Identifier: GPL-3.0-or-later
#include "transfer/quadratic_matrix.h"

#include "grid/ring.h"
#include "sparse/matrix.h"
#include "transfer/quadratic.h"

namespace fairing {
namespace {

class HalfWay {
 public:
  HalfWay(const GridLevel& coarse, const Stencils& stencils, const Unknowns& unknowns,
          Workers& workers)
      : mesh_(coarse.mesh()),
        stencils_(stencils),
        vertices_(coarse.mesh().vertex_count()),
        edges_(Index(coarse.mesh().edges.size())),
        rings_(coarse, unknowns, workers) {}

  const RingTable& rings() const { return rings_; }

  // Adds `share` of the fit about p, half-way to its neighbour q.
  void add(Index p, Index q, double share, RowBuilder& row) const {
    const RingTable::Ring& ring = rings_.about(p);
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
  void put(const RingTable::Ring& ring, double share, RowBuilder& row, Number&& number) const {
    const RingTable::Member* members = rings_.members(ring);
    double own = 1;
    for (std::size_t m = 0; m + 1 < ring.size; ++m) {
      const double b = number(m);
      own -= b;
      if (b != 0 && members[m + 1] >= 0) row.add(members[m + 1], share * b);
    }
    if (members[0] >= 0) row.add(members[0], share * own);
  }

  void about_vertex(const RingTable::Ring& ring, std::size_t slot, double share,
                    RowBuilder& row) const {
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
  void linear_about_vertex(const RingTable::Ring& ring, std::size_t slot, double share,
                           RowBuilder& row) const {
    const auto spokes = mesh_.ring(ring.element);
    std::size_t at = 0;  // the place of a spoke's neighbour
    for (std::size_t k = 0; k < spokes.size(); ++k) {
      const bool quad = spokes[k].face >= 0 && mesh_.faces[std::size_t(spokes[k].face)].quad();
      if (slot == at)
        return put(ring, share, row, [&](std::size_t m) { return m == at ? 0.5 : 0.0; });
      if (quad && slot == at + 1) {
        const std::size_t next = k + 1 < spokes.size() ? at + 2 : 0;
        return put(ring, share, row,
                   [&](std::size_t m) { return m == at || m == at + 1 || m == next ? 0.25 : 0.0; });
      }
      at += quad ? 2 : 1;
    }
  }

  void about_edge(const RingTable::Ring& ring, std::size_t slot, double share,
                  RowBuilder& row) const {
    const float* half =
        stencils_.edge_half.data() + 64 * std::size_t(ring.element - vertices_) + 8 * slot;
    put(ring, share, row, [&](std::size_t m) { return double(half[m]); });
  }

  void inside(const RingTable::Ring& ring, std::size_t slot, double share, RowBuilder& row) const {
    const std::size_t count = ring.size - 1, opposite = (slot + count / 2) % count;
    put(ring, share, row, [&](std::size_t m) {
      return m == slot ? MidpointWeights::ahead : m == opposite ? MidpointWeights::behind : 0.0;
    });
  }

  const ControlMesh& mesh_;
  const Stencils& stencils_;
  Index vertices_, edges_;
  RingTable rings_;
};

// Rows of the prolongation for the points of the fine level, one after another.
class FineRows {
 public:
  FineRows(const GridLevel& coarse, const GridLevel& fine, const HalfWay& half)
      : coarse_(coarse), fine_(fine), half_(half), first_in_faces_(fine.face_base(0)) {}

  void write(Index p, RowBuilder& row) {
    const int n = fine_.n();
    const Index vertices = fine_.mesh().vertex_count();
    if (p < vertices) return row.add(p, 1);
    if (p < first_in_faces_) {
      const Index e = (p - vertices) / (n - 1), k = (p - vertices) % (n - 1) + 1;
      return between(coarse_.edge_point(e, k / 2), coarse_.edge_point(e, (k + 1) / 2),
                     midpoint_share, row);
    }
    go_to(p);
    const auto corner = [&](int i, int j) {
      return coarse_.face_point(face_, (at_.i + i) / 2, (at_.j + j) / 2);
    };
    const bool odd_i = at_.i % 2, odd_j = at_.j % 2;
    if (odd_i && odd_j && is_quad()) {
      between(corner(-1, -1), corner(1, 1), centre_share, row);
      between(corner(1, -1), corner(-1, 1), centre_share, row);
    } else if (odd_i && odd_j) {
      between(corner(1, -1), corner(-1, 1), midpoint_share, row);
    } else {
      between(corner(odd_i ? -1 : 0, odd_j ? -1 : 0), corner(odd_i ? 1 : 0, odd_j ? 1 : 0),
              midpoint_share, row);
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

  bool is_quad() const { return fine_.mesh().faces[std::size_t(face_)].quad(); }

  // To the face that holds p, and its place there: the next one, mostly.
  void go_to(Index p) {
    const int n = fine_.n();
    if (p != last_ + 1 || last_ < first_in_faces_) {
      Index low = 0, high = Index(fine_.mesh().faces.size());
      while (high - low > 1) {
        const Index middle = low + (high - low) / 2;
        (fine_.face_base(middle) <= p ? low : high) = middle;
      }
      face_ = low;
      begin_face();
      for (Index k = fine_.face_base(face_); k < p; ++k) step();
    } else {
      step();
      while (at_.j >= n || (!is_quad() && at_.j >= n - 1)) {
        ++face_;
        begin_face();
      }
    }
    last_ = p;
  }
  void begin_face() { at_ = {1, 1}; }
  void step() {
    if (++at_.i < (is_quad() ? fine_.n() : fine_.n() - at_.j)) return;
    at_ = {1, at_.j + 1};
  }

  const GridLevel &coarse_, &fine_;
  const HalfWay& half_;
  Index first_in_faces_, last_ = -1, face_ = 0;
  GridPoint at_{1, 1};
};

// Numbers in rows about control vertices whose rings are large, at the most and on average over all
// points: each of a ring's points has a row with all others.
constexpr std::size_t most_in_large_rings = 16;

bool suits(const GridLevel& fine, const Stencils& stencils) {
  if (!has_rows(fine.n(), fine.size())) return false;
  std::size_t numbers = 0;
  for (std::size_t v = 0; v + 1 < stencils.ring_offset.size(); ++v) {
    const auto size = std::size_t(stencils.ring_offset[v + 1] - stencils.ring_offset[v]);
    if (size > large_ring) numbers += size * size;
  }
  return numbers <= most_in_large_rings * fine.size();
}

}  // namespace

std::unique_ptr<AssembledTransfer> AssembledTransfer::make(const GridLevel& coarse,
                                                           const GridLevel& fine,
                                                           const Stencils& stencils,
                                                           const Unknowns& unknowns,
                                                           Workers& workers) {
  if (!suits(fine, stencils)) return nullptr;
  const HalfWay half(coarse, stencils, unknowns, workers);
  const std::vector<std::uint8_t> unknown = unknown_points(fine, unknowns);
  const auto fine_writer = [&] {
    return [&unknown, rows = FineRows(coarse, fine, half)](Index p, RowBuilder& row) mutable {
      if (unknown[std::size_t(p)]) rows.write(p, row);
    };
  };
  Matrix prolongation = AssembledMatrix::make(fine.size(), coarse.size(), workers, fine_writer);
  if (!prolongation) return nullptr;
  const MatrixColumns columns = prolongation->by_columns(workers);
  const auto coarse_writer = [&] {
    return [&columns](Index p, RowBuilder& row) {
      for (std::size_t k = columns.first[std::size_t(p)]; k < columns.first[std::size_t(p) + 1];
           ++k)
        row.add(columns.entry[k].row, double(columns.entry[k].number));
    };
  };
  Matrix restriction = AssembledMatrix::make(coarse.size(), fine.size(), workers, coarse_writer);
  if (!restriction) return nullptr;
  return std::unique_ptr<AssembledTransfer>(
      new AssembledTransfer(std::move(prolongation), std::move(restriction)));
}

}  // namespace fairing
