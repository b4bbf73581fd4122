// SPDX-License-Identifier: GPL-3.0-or-later
// What the solver asks of an energy on one level: the action of its matrix and the diagonal. A new energy is a new
// LevelOperator; the solver knows nothing else of it.
#pragma once

#include <cstddef>

#include "execution/memory.h"
#include "execution/workers.h"
#include "solver/assembled_system.h"

namespace fairing {

// Vectors in single precision have room for so many numbers more: operators may read them in packs.
constexpr std::size_t vector_room = 16;

// One step of a smoother for K x = b:  r -= K d,  next = carry d + gain D^-1 r,  x += next, and d too where that is still
// to be added.
struct SmoothingStep {
  const float* d;
  float *next, *x, *r;
  float carry, gain;
  bool adds_d;
};

// The finest subdivision of control edges for which fourth differences of smooth vectors survive in single precision.
constexpr int most_of_single = 32;

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
  // Whether apply() in single precision tells smooth vectors from zero: of fourth order, it cancels their leading digits.
  virtual bool does_with_single() const = 0;
  virtual const Array<float>& inverse_diagonal() const = 0;
  // Both may be overridden by something faster than one application, and then passes over the vectors.
  virtual void relax(const SmoothingStep& step, Workers& workers);
  virtual void subtract_image(const float* x, float* room, float* y, Workers& workers);  // y -= K x
  virtual AssembledSystem assemble() const = 0;                                          // small levels only
};

// Moves vectors between a level and the next coarser one; the two are transposes of one another.
class LevelTransfer {
 public:
  virtual ~LevelTransfer() = default;
  virtual void prolong(const float* coarse, float* fine) = 0;
  virtual void restrict_to(const float* fine, float* coarse) = 0;
};

}  // namespace fairing
