// SPDX-License-Identifier: GPL-3.0-or-later
#include "energy/sparse_square.h"

#include "energy/assemble.h"
#include "energy/ring_passes.h"
#include "execution/cancel.h"

namespace fairing {
namespace {

constexpr std::size_t most_products = 128;   // a point
constexpr std::size_t regular_columns = 25;  // inside a quad: the ring's rings
constexpr std::uint16_t none = 0xffff;
constexpr std::size_t grain = 1024;  // rows

}  // namespace

bool SparseSquare::suits(const RingRows& rows) {
  const Lattice& lattice = rows.lattice();
  if (lattice.n() > most_points_of_square) return false;
  std::size_t products = 81 * lattice.size();
  for (Index v = 0; v < lattice.mesh().vertex_count(); ++v) {
    const auto slots = std::size_t(rows.vertex(v).slots);
    products += slots * slots;
  }
  return products < most_products * lattice.size();
}

SparseSquare::SparseSquare(const RingRows& rows, const Unknowns& unknowns) : lattice_(rows.lattice()) {
  const float* origin = rows.vertex(0).coefficient;
  visit_rows(rows,
             [&](Index, const RowRun<const float>& run, std::size_t i, const std::vector<Index>& points) {
               stop_if_cancelled(ring_.size());
               ring_.push_back({std::size_t(&run.at(0, 0, i) - origin), std::uint32_t(member_.size()),
                                std::uint32_t(run.count)});
               member_.insert(member_.end(), points.begin(), points.end());
             });
  ring_.push_back({0, std::uint32_t(member_.size()), 0});
  jacobian_.resize(3 * member_.size());
  const std::vector<Index> unknown = number_unknowns(lattice_, unknowns);
  find_parts(unknown);
  find_columns(unknown);
  number_.resize(column_.size());
}

void SparseSquare::find_parts(const std::vector<Index>& unknown) {
  part_begin_.assign(unknown.size() + 1, 0);
  for (std::size_t m = 0; m < member_.size(); ++m) {
    stop_if_cancelled(m);
    if (const auto q = std::size_t(member_[m]); unknown[q] >= 0) ++part_begin_[q + 1];
  }
  for (std::size_t p = 0; p < unknown.size(); ++p) part_begin_[p + 1] += part_begin_[p];
  part_.resize(part_begin_.back());
  Array<std::size_t> next(part_begin_.begin(), part_begin_.end() - 1);
  for (std::uint32_t r = 0; r < unknown.size(); ++r) {
    stop_if_cancelled(r);
    for (std::uint32_t k = ring_[r].begin; k < ring_[r + 1].begin; ++k) {
      const auto q = std::size_t(member_[k]);
      if (unknown[q] >= 0) part_[next[q]++] = {r, k - ring_[r].begin};
    }
  }
}

void SparseSquare::find_columns(const std::vector<Index>& unknown) {
  std::size_t places = 0;
  for (const Part& part : part_) places += ring_[part.ring + 1].begin - ring_[part.ring].begin;
  place_.reserve(places);
  column_.reserve(regular_columns * unknown.size());
  std::vector<std::size_t> seen(unknown.size(), 0);  // 1 + the place among all columns
  for (std::size_t p = 0; p < unknown.size(); ++p) {
    stop_if_cancelled(p);
    const std::size_t first = column_.size();
    column_begin_.push_back(first);
    place_begin_.push_back(place_.size());
    for (std::size_t k = part_begin_[p]; k < part_begin_[p + 1]; ++k) {
      const std::uint32_t r = part_[k].ring;
      for (std::uint32_t m = ring_[r].begin; m < ring_[r + 1].begin; ++m) {
        const auto q = std::size_t(member_[m]);
        if (unknown[q] < 0) {
          place_.push_back(none);
          continue;
        }
        if (seen[q] <= first) {
          column_.push_back(Index(q));
          seen[q] = column_.size();
        }
        place_.push_back(Place(seen[q] - 1 - first));
      }
    }
  }
  column_begin_.push_back(column_.size());
  place_begin_.push_back(place_.size());
}

void SparseSquare::update(const RingRows& rows, Workers& workers) {
  const float* origin = rows.vertex(0).coefficient;
  const std::size_t points = lattice_.size();
  workers.for_parts(points, grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t p = begin; p < end; ++p) {
      const Ring& ring = ring_[p];
      const std::size_t slots = ring_[p + 1].begin - ring.begin;
      for (std::size_t s = 0; s < slots; ++s)
        for (std::size_t c = 0; c < 3; ++c)
          jacobian_[3 * (ring.begin + s) + c] = origin[ring.first + (c * slots + s) * ring.stride];
    }
  });
  workers.for_parts(points, grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t p = begin; p < end; ++p) {
      float* row = number_.data() + column_begin_[p];
      std::fill(row, number_.data() + column_begin_[p + 1], 0.0f);
      const Place* place = place_.data() + place_begin_[p];
      for (std::size_t k = part_begin_[p]; k < part_begin_[p + 1]; ++k) {
        const Part part = part_[k];
        const float* own = jacobian_.data() + 3 * (ring_[part.ring].begin + part.slot);
        const float* other = jacobian_.data() + 3 * ring_[part.ring].begin;
        for (const float* last = jacobian_.data() + 3 * ring_[part.ring + 1].begin; other < last; other += 3)
          if (const Place to = *place++; to != none)
            row[to] += own[0] * other[0] + own[1] * other[1] + own[2] * other[2];
      }
    }
  });
}

void SparseSquare::apply(const float* x, Workers& workers, float* y) const {
  workers.for_parts(lattice_.size(), grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t p = begin; p < end; ++p) {
      float sum[2] = {0, 0};
      std::size_t k = column_begin_[p];
      const std::size_t last = column_begin_[p + 1];
      for (; k + 1 < last; k += 2) {
        sum[0] += number_[k] * x[column_[k]];
        sum[1] += number_[k + 1] * x[column_[k + 1]];
      }
      if (k < last) sum[0] += number_[k] * x[column_[k]];
      y[p] = sum[0] + sum[1];
    }
  });
}

}  // namespace fairing
