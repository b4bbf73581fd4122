// SPDX-License-Identifier: GPL-3.0-or-later
// Vectors of unknowns between a level and the next coarser one in single precision, for multigrid
// cycles; and from a level to the control vertices.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "parallel/reductions.h"
#include "transfer/quadratic.h"

namespace fairing {

// The two are transposes of each other. Zero on points that are not unknowns. Input vectors have
// `vector_room` (multigrid/level_operator.h) extra numbers. Both throw FairingError(cancelled).
class LevelTransfer {
 public:
  virtual ~LevelTransfer() = default;
  virtual void prolong(const float* coarse, float* fine) = 0;
  virtual void restrict_to(const float* fine, float* coarse) = 0;
};

// Local quadratics, with C numbers a point: 3 coordinates, or 1 displacement.
template <int C>
class QuadraticTransfer final : public LevelTransfer {
 public:
  // All must outlive the transfer; `slots` may be shared by all levels.
  QuadraticTransfer(const GridLevel& coarse, const GridLevel& fine, const Stencils& stencils,
                    const Unknowns& unknowns, Workers& workers, ElementSlots<float, C>& slots)
      : coarse_(coarse),
        fine_(fine),
        stencils_(stencils),
        unknowns_(unknowns),
        workers_(workers),
        slots_(slots) {}

  void prolong(const float* x, float* y) override {
    fairing::prolong(coarse_, fine_, stencils_, &unknowns_, workers_, slots_, x, y);
  }
  void restrict_to(const float* x, float* y) override { restrict_to(unknowns_, x, y); }
  // To these unknowns.
  void restrict_to(const Unknowns& unknowns, const float* x, float* y) {
    fairing::restrict_to(coarse_, fine_, stencils_, unknowns, workers_, slots_, x, y);
  }

 private:
  const GridLevel &coarse_, &fine_;
  const Stencils& stencils_;
  const Unknowns& unknowns_;
  Workers& workers_;
  ElementSlots<float, C>& slots_;
};

// For all levels from 1 on.
template <int C>
using QuadraticTransfers = std::vector<std::unique_ptr<QuadraticTransfer<C>>>;

// sums <- H^T r of a level for the `carried` control vertices, with H their prolongation through
// all levels; zero elsewhere. room(l) returns a work vector of level l.
template <int C, class Room>
void restrict_to_vertices(const QuadraticTransfers<C>& transfers, int level,
                          const Unknowns& carried, Workers& workers, std::span<const double> r,
                          Room&& room, std::span<Eigen::Matrix<double, C, 1>> sums) {
  Array<float> vertices(C * sums.size());
  const auto at = [&](int l) { return l > 0 ? room(l) : vertices.data(); };
  float* const finest = at(level);
  for_each_index(workers, r.size(), [&](std::size_t i) { finest[i] = float(r[i]); });
  for (int l = level; l > 0; --l) transfers[l - 1]->restrict_to(carried, at(l), at(l - 1));
  for (std::size_t v = 0; v < sums.size(); ++v)
    sums[v] =
        Eigen::Map<const Eigen::Matrix<float, C, 1>>(&vertices[C * v]).template cast<double>();
}

}  // namespace fairing
