// SPDX-License-Identifier: GPL-3.0-or-later
#include "curvature/level.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "parallel/reductions.h"
#include "sparse/unknown_points.h"

namespace fairing {
namespace {

// The rows ring by ring, member by member, in the form that K is summed from
// (sparse/ring_matrix.h).
class JacobianRows {
 public:
  using Column = std::array<float, 3>;

  // `tension`: the weights of AreaTerm, or null.
  JacobianRows(const RingRows& rows, const RingRows* tension, const Unknowns& unknowns,
               Workers& workers)
      : rings_(rows.grid(), unknowns, workers) {
    const RingTable::Ring& last = rings_.about(Index(rings_.points() - 1));
    column_.resize(last.member + last.size);
    if (tension) tension_.resize(column_.size());
    for_each_run(rows.grid(), workers, [&](const Run& run) {
      const RowRun<const float> own = rows.of(run);
      std::size_t m = rings_.about(Index(run.first)).member;
      for (std::size_t i = 0; i < run.count; ++i)
        for (int s = 0; s < own.slots; ++s, ++m) {
          column_[m] = {own.at(0, s, i), own.at(1, s, i), own.at(2, s, i)};
          if (tension) tension_[m] = tension->of(run).at(0, s, i);
        }
    });
  }

  const RingTable& rings() const { return rings_; }
  static bool has_rows(const RingTable::Ring&) { return true; }
  const Column& column(const RingTable::Ring& ring, std::size_t slot) const {
    return column_[ring.member + slot];
  }
  static double weight(Index) { return 1; }
  void add_own(Index p, RowSum& sum) const {
    const RingTable::Ring& ring = rings_.about(p);
    for (std::size_t s = 1; s < ring.size && !tension_.empty(); ++s) {
      const double weight = tension_[ring.member + s];
      sum.add(p, weight);
      if (const RingTable::Member q = rings_.members(ring)[s]; q >= 0) sum.add(q, -weight);
    }
  }

 private:
  const RingTable rings_;
  Array<Column> column_;
  Array<float> tension_;
};

}  // namespace

CurvatureLevel::CurvatureLevel(CurvatureShared& shared, const GridLevel& grid)
    : shared_(shared),
      grid_(grid),
      rows_(grid),
      has_matrix_(RingMatrix<1>::suits(grid, most_pieces)) {}

void CurvatureLevel::apply_rows(const double* x, double* y) {
  apply_square(rows_, shared_.unknowns, shared_.workers, shared_.double_slots, x, y);
  if (is_tense()) area_->add_product(shared_.unknowns, shared_.workers, x, y);
}

void CurvatureLevel::apply_rows(const float* x, float* y) {
  apply_square(rows_, shared_.unknowns, shared_.workers, shared_.float_slots, x, y);
  if (is_tense()) area_->add_product(shared_.unknowns, shared_.workers, x, y);
}

void CurvatureLevel::apply(const float* x, float* y) {
  if (has_matrix_)
    matrix().apply(x, shared_.workers, y);
  else
    apply_rows(x, y);
  if (!varies()) return add_to_product(x, y);
  if (penalty_)
    for_each_index(shared_.workers, grid_.size(),
                   [&](std::size_t i) { y[i] += float(penalty_at(i, true)) * x[i]; });
}

const RingMatrix<1>& CurvatureLevel::matrix() {
  if (!matrix_)
    matrix_.emplace(JacobianRows(rows_, is_tense() ? &area_->weights() : nullptr, shared_.unknowns,
                                 shared_.workers),
                    shared_.workers);
  return *matrix_;
}

void CurvatureLevel::apply(const double* x, double* y) {
  if (varies()) {
    Array<double>&moment = shared_.moment, &turned = shared_.turned;
    moment.resize(3 * grid_.size());
    turned.resize(3 * grid_.size());
    compute_moments(rows_, shared_.workers, x, moment.data());
    variation_->connection->apply(share_, shared_.workers, moment.data(), turned.data());
    apply_transposed(rows_, shared_.unknowns, shared_.workers, shared_.double_slots, turned.data(),
                     y);
    if (is_tense()) area_->add_product(shared_.unknowns, shared_.workers, x, y);
  } else {
    apply_rows(x, y);
  }
  add_to_product(x, y);
}

void CurvatureLevel::find_between(const Array<double>& area) {
  const std::size_t points = grid_.size();
  Array<float>&root = variation_->root, &beside_cotangents = variation_->beside_cotangents,
  &cycle_diagonal = variation_->cycle_diagonal;
  cycle_diagonal.resize(points);
  square_diagonal(rows_, shared_.unknowns, shared_.workers, shared_.float_slots, nullptr,
                  cycle_diagonal.data());
  root.resize(points);
  for_each_index(shared_.workers, points,
                 [&](std::size_t i) { root[i] = float(std::sqrt(area[i])); });
  // Two edges lead to the border, and C's weights are about one. (Measured: with half or twice this
  // number, panels take up to half as many iterations more.)
  const auto stiffness = float(2 * grid_.n());
  beside_cotangents.resize(points);
  for_each_run(
      grid_, shared_.workers, [&] { return RunGather<double>(grid_, area.data()); },
      [&](const Run& run, RunGather<double>& gather) {
        const int slots = rows_.of(run).slots;
        const double* const* at = gather(run);
        for (std::size_t i = 0; i < run.count; ++i) {
          bool is_beside = false;
          for (int s = 1; s < slots; ++s) is_beside |= !(at[s][i] > 0);
          const std::size_t p = run.first + i;
          beside_cotangents[p] =
              (is_beside ? stiffness : 0.0f) + (penalty_ ? float(penalty_->between(p)) : 0.0f);
        }
      });
}

void CurvatureLevel::apply_between(const float* x, float* y) {
  const Variation& of = *variation_;
  Array<float> scaled(grid_.size());
  for_each_index(shared_.workers, grid_.size(),
                 [&](std::size_t i) { scaled[i] = of.root[i] * x[i]; });
  of.connection->apply_to_scalar(shared_.workers, scaled.data(), y);
  for_each_run(grid_, shared_.workers, [&](const Run& run) {
    const bool is_unknown = shared_.unknowns.has(run);
    for (std::size_t i = run.first; i < run.first + run.count; ++i)
      y[i] = is_unknown ? of.root[i] * y[i] + of.beside_cotangents[i] * x[i] : 0.0f;
  });
}

template <class T>
void CurvatureLevel::add_to_product(const T* x, T* y) const {
  for (std::size_t v = 0; v < weights_.size(); ++v) y[v] += T(weight(v)) * x[v];
  add_diagonal(x, y);
}

void CurvatureLevel::apply_on(const Unknowns& rows, const double* x, double* y) {
  apply_square(rows_, rows, shared_.workers, shared_.double_slots, x, y);
  if (is_tense()) area_->add_product(rows, shared_.workers, x, y);
  add_diagonal(x, y);
}

template <class T>
void CurvatureLevel::add_diagonal(const T* x, T* y) const {
  if (penalty_ || !damping_.empty())
    for_each_index(shared_.workers, grid_.size(),
                   [&](std::size_t i) { y[i] += T(added_to_diagonal(i)) * x[i]; });
}

void CurvatureLevel::predict(const Array<float>& shape, const double* h, Array<float>& predicted) {
  predicted.resize(3 * grid_.size());
  // the moments are sqrt(w) J h
  visit_moments(rows_, shared_.workers, h, [&](const Run& run, const double* moment) {
    for (std::size_t i = 0; i < run.count; ++i) {
      const std::size_t p = run.first + i;
      const float* m = &shape[4 * p];
      for (std::size_t c = 0; c < 3; ++c)
        predicted[3 * p + c] =
            m[3] > 0 ? m[c] + float(moment[c * run.count + i] / double(m[3])) : 0.0f;
    }
  });
}

void CurvatureLevel::write_lines(LineBand& band, Workers& workers) {
  if (has_matrix_)
    return band.write(inverse_diagonal_, [&](const auto& wants, const auto& visit) {
      matrix().visit_numbers(workers, wants, visit);
    });
  const JacobianRows rows(rows_, is_tense() ? &area_->weights() : nullptr, shared_.unknowns,
                          workers);
  band.write(inverse_diagonal_, [&](const auto& wants, const auto& visit) {
    visit_numbers(rows, workers, wants, visit);
  });
}

void CurvatureLevel::set_damping(const Array<float>& mu, double share) {
  if (mu.empty() && damping_.empty() && share == share_) return;
  if (std::exchange(share_, share) != share) update_diagonal();
  damping_.resize(mu.size());
  for (std::size_t i = 0; i < damping_.size(); ++i) damping_[i] = mu[i] * diagonal_[i];
  invert_diagonal();
}

void CurvatureLevel::invert_diagonal() {
  ++version_.numbers;
  inverse_diagonal_.resize(grid_.size());
  for (std::size_t i = 0; i < inverse_diagonal_.size(); ++i) invert_diagonal(i);
}

void CurvatureLevel::set_weights(const VertexWeights& weights) {
  if (weights == weights_) return;
  ++version_.numbers;
  const std::size_t changed = std::max(weights_.size(), weights.size());
  weights_ = weights;
  for (std::size_t v = 0; v < std::min(changed, diagonal_.size()); ++v) invert_diagonal(v);
}

void CurvatureLevel::invert_diagonal(std::size_t i) {
  float d = varies() ? variation_->cycle_diagonal[i] + float(penalty_at(i, true)) : diagonal_[i];
  if (!varies() && i < weights_.size()) d += float(weight(i));
  if (!varies()) d += float(added_to_diagonal(i));
  inverse_diagonal_[i] = d > 0 ? 1 / d : 1.0f;
}

// The variation takes the diagonal of J^T diag(L + share W) J; it scales as well as the exact one.
void CurvatureLevel::update_diagonal() {
  const std::size_t points = grid_.size();
  Array<float> weight;
  if (varies()) {
    weight.resize(points);
    visit_rows(variation_->connection->rows(),
               [&](Index p, const RowRun<const float>& run, std::size_t i, const auto&) {
                 weight[p] = run.at(0, 0, i) + float(share_);
               });
  }
  diagonal_.resize(points);
  square_diagonal(rows_, shared_.unknowns, shared_.workers, shared_.float_slots,
                  varies() ? weight.data() : nullptr, diagonal_.data());
  if (is_tense()) area_->add_diagonal(shared_.unknowns, diagonal_.data());
}

}  // namespace fairing
