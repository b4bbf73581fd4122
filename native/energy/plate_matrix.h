// SPDX-License-Identifier: GPL-3.0-or-later
// The thin plate's K on one level as a sparse matrix in single precision, for levels whose faces have few points: there
// passes over faces and edges cost more than an index a number. For the smoother, which wants many cheap applications.
#pragma once

#include <memory>

#include "energy/plate_rings.h"
#include "rows/matrix.h"
#include "solver/level_operator.h"

namespace fairing {

class PlateMatrix {
 public:
  // Null where the passes are better: with many points a face, or rings so large that their squares are not linear.
  static std::unique_ptr<PlateMatrix> make(const Lattice& lattice, const Stencils& stencils,
                                           const Unknowns& unknowns, Workers& workers);

  // Of control vertices: what is added to their diagonal.
  void set_weights(const VertexWeights& weights);

  Array<float> inverse_diagonal(Workers& workers) const;  // one number a point; 1 where it is no unknown

  // Calls finish(point, count, image) with K x on so many points, 3 numbers each; x has `vector_room` more.
  template <class Finish>
  void visit_images(const float* x, Workers& workers, const Finish& finish) const {
    rows_.visit_images<3>(x, workers, [&](std::size_t first, std::size_t count, float* image) {
      for (std::size_t i = 3 * first; i < std::min(3 * (first + count), weight_.size()); ++i)
        image[i - 3 * first] += weight_[i] * x[i];
      finish(first, count, static_cast<const float*>(image));
    });
  }

 private:
  PlateMatrix(const Lattice& lattice, const Unknowns& unknowns)
      : points_(lattice.size()), rows_(points_, points_), moves_(unknowns.vertex) {}

  std::size_t points_;
  WrittenMatrix rows_;
  std::vector<std::uint8_t> moves_;  // whether a control vertex is an unknown
  std::vector<float> weight_;        // 3 a control vertex; empty: none
};

}  // namespace fairing
