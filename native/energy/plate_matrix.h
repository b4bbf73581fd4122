// SPDX-License-Identifier: GPL-3.0-or-later
// The thin plate's K on one level in single precision, row by row: deep inside a face all rows are one stencil, which is
// kept once; all others are written out. For the smoother, which wants many cheap applications, each with its own
// update of vectors: rows are finished where they are computed.
#pragma once

#include "energy/plate_rings.h"
#include "rows/chunk.h"
#include "solver/level_operator.h"

namespace fairing {

class PlateMatrix {
 public:
  // Whether the rows to be written are not too many, and no rings so large that their squares are not linear.
  static bool suits(const Lattice& lattice, const Stencils& stencils);

  PlateMatrix(const Lattice& lattice, const ThinPlateRows<float>& rows, const Unknowns& unknowns,
              Workers& workers);
  ~PlateMatrix();

  // Of control vertices, in place of earlier ones.
  void set_weights(const VertexWeights& weights);

  // One number a point; 1 where it is no unknown.
  Array<float> inverse_diagonal() const;

  // Vectors have 3 numbers a point; x and d, moreover, `vector_room`.
  void apply(const float* x, Workers& workers, float* y) const;
  void subtract_image(const float* x, Workers& workers, float* y) const;  // y -= K x
  void relax(const SmoothingStep& step, const float* inverse_diagonal, Workers& workers) const;

 private:
  void cut_into_runs(const Unknowns& unknowns);
  void write_rows(const PlateRings& rings, Workers& workers);
  void write_stencils(const ThinPlateRows<float>& rows);
  // Calls visit(point, first, last) for the numbers of every written row of a chunk.
  template <class Chunk, class Visit>
  static void visit_written(Chunk& chunk, Index point, Visit&& visit);

  template <class Finish>
  void visit_images(const float* x, Workers& workers, const Finish& finish) const;

  const Lattice& lattice_;
  Array<RowChunk> chunk_;
  Array<FaceStencil> stencil_;     // per face
  std::vector<float> unweighted_;  // diagonal of control vertices
  std::size_t bytes_ = 0;
};

}  // namespace fairing
