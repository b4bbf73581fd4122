// SPDX-License-Identifier: GPL-3.0-or-later
// K as a sparse matrix: for the direct solve on the coarsest level, for the paper's Gauss-Seidel, and to check and
// to race the matrix-free passes. Never formed on fine levels otherwise.
#pragma once

#include <vector>

#include "energy/thin_plate.h"
#include "solver/assembled_system.h"

namespace fairing {

// A divided difference written out: coefficients of the centre and of its ring, three rows each.
struct WrittenStencil {
  std::vector<Index> points;                  // the centre first
  std::vector<std::array<double, 3>> column;  // one a point; sqrt(weight) and the level's scale included
};

// Calls visit(const WrittenStencil&) for every point of the level that carries a fit.
template <class Visit>
void visit_stencils(const Lattice& lattice, const Stencils& stencils, Visit&& visit);

// Numbers the unknown points of a level 0, 1, …; -1 for the others.
std::vector<Index> number_unknowns(const Lattice& lattice, const Unknowns& unknowns);

AssembledSystem assemble_thin_plate(const Lattice& lattice, const Stencils& stencils,
                                    const Unknowns& unknowns, const VertexWeights& weights);

}  // namespace fairing

#include "energy/assemble_inl.h"
