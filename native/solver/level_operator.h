// SPDX-License-Identifier: GPL-3.0-or-later
// What the solver asks of an energy on one level: the action of its matrix and the diagonal. A new energy is a new
// LevelOperator; the solver knows nothing else of it.
#pragma once

#include <cstddef>

#include "execution/memory.h"
#include "solver/assembled_system.h"

namespace fairing {

// A symmetric positive definite operator on the unknown points of a level. Vectors hold components() interleaved numbers
// a point, which the operator does not mix: x, y and z, or one displacement. Results are zero on points that are not
// unknowns.
class LevelOperator {
 public:
  virtual ~LevelOperator() = default;
  virtual std::size_t points() const = 0;
  virtual std::size_t components() const = 0;
  std::size_t size() const { return components() * points(); }  // of a vector
  virtual void apply(const double* x, double* y) = 0;
  virtual void apply(const float* x, float* y) = 0;  // inside the preconditioner
  virtual const Array<float>& inverse_diagonal() const = 0;
  virtual AssembledSystem assemble() const = 0;  // small levels only
};

// Moves vectors between a level and the next coarser one; the two are transposes of one another.
class LevelTransfer {
 public:
  virtual ~LevelTransfer() = default;
  virtual void prolong(const float* coarse, float* fine) = 0;
  virtual void restrict_to(const float* fine, float* coarse) = 0;
};

}  // namespace fairing
