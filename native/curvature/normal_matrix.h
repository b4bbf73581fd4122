// SPDX-License-Identifier: GPL-3.0-or-later
// R^T R, or R^T L R with the connection Laplacian L, with tension's Laplacian, as one sparse matrix
// in single precision, for levels whose faces have few points: there most points lie on control
// edges and at control vertices, and passes over runs cost several times what an index a number
// does.
#pragma once

#include <cstdint>
#include <vector>

#include "curvature/connection.h"
#include "sparse/matrix.h"

namespace fairing {

// Pieces of a control edge up to which a level is for it: with more, most points lie inside faces,
// and what differences of sixth order leave of smooth vectors, some n^-6, is rounding.
constexpr int most_pieces_of_matrix = 8;

// L + share; null: nothing stands between R^T and R.
struct SharedConnection {
  const Connection* connection = nullptr;
  float share = 0;
};

class NormalMatrix {
 public:
  // Whether a level is better served so: few points a face, and no rings so large that their squares
  // are not linear.
  static bool suits(const RingJacobian& rows);

  // R^T R, or with L between.
  enum class Middle : std::uint8_t { none, connection };

  // The pattern: the unknowns that share a ring, or have points in neighbouring rings. The grid of
  // `rows` must outlive it. Throws ErrorCode::cancelled.
  NormalMatrix(const RingJacobian& rows, const Unknowns& unknowns, Middle middle = Middle::none);

  Middle middle() const { return middle_; }

  // The numbers of rows with that pattern; `tension`: the weights of AreaTerm; `between`: of the
  // rows' grid, where the middle is the connection.
  void update(const RingJacobian& rows, Workers& workers, const RingJacobian* tension = nullptr,
              const SharedConnection& between = {});

  // y <- the matrix times x; zero where a point is no unknown.
  void apply(const float* x, Workers& workers, float* y) const;

 private:
  using LocalColumn = std::uint16_t;

  // In RingJacobian row c's coefficient for slot s is data()[first + (c * slots + s) * stride].
  struct Ring {
    std::size_t first;
    std::uint32_t stride;
  };
  // Three rows a point, over the same members: those of point p begin at member[begin[p]].
  struct MomentRows {
    Array<std::uint32_t> begin;  // one a point, and one more
    Array<Index> member;
    Array<float> number;  // three a member

    std::size_t size(std::size_t p) const { return begin[p + 1] - begin[p]; }
  };
  // A point's part in a ring: it is in this slot.
  struct RingSlot {
    std::uint32_t ring, slot;
  };
  const MomentRows& turned() const { return middle_ == Middle::none ? jacobian_ : turned_; }
  void find_turned();
  void find_ring_slots(const std::vector<Index>& unknown);
  void find_columns(const std::vector<Index>& unknown);
  void update_turned(const SharedConnection& between, Workers& workers);
  void add_tension(const RingJacobian& weights, Workers& workers);

  const GridLevel& grid_;
  Middle middle_;
  Array<Ring> ring_;     // one a point
  MomentRows jacobian_;  // R: over the rings, a point itself first
  MomentRows turned_;    // L R: over the rings of a ring, those of the point's own first
  // By ring, for each member of it, for each of that one's ring: where that is in turned_, counted
  // within the ring.
  Array<std::size_t> place_begin_;
  Array<LocalColumn> place_;
  // By point, and one more: where its ring slots, columns and targets begin.
  Array<std::size_t> ring_slot_begin_, column_begin_, target_begin_;
  Array<RingSlot> ring_slot_;
  // For each ring slot of a point, for each member of turned() there: the column, counted within
  // the point's row, to which their product is added; `none` where the member is no unknown.
  Array<LocalColumn> target_;
  Array<Index> column_;
  Array<float> number_;
};

}  // namespace fairing
