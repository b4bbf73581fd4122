// SPDX-License-Identifier: GPL-3.0-or-later
// Loads as lengths: over the load that a vertex asks for when it alone moves, a load is the way by
// which the surface would spring there, were that one vertex let go. On curves it is the way that
// makes their loads (strain/curve_loads.h) least.
#pragma once

#include <optional>
#include <vector>

#include "fairing/problem.h"
#include "strain/curve_loads.h"
#include "strain/probes.h"

namespace fairing {

// Ways of the surface, one an input vertex, in mesh units; and their parts along the control mesh's
// normal, on curves the whole, over zero on the normal's side. NaN at corners, at and next to ends of
// curves, and outside a region.
struct Ways {
  std::vector<Vec3> ways;
  std::vector<double> lengths;
};

// The part of strain that is a vertex' own: less what vertices that strain more do to it
// (strain/excess.h), of loads that have moments on borders (strain/border_moments.h).
struct Excess {
  Ways own;
  // What scatter makes of it. By a median, which a few wrong vertices do not change.
  double floor = 0;
  // One an input vertex, over zero: it is above that, and stands out from what is around it. A fair
  // shape strains between its vertices too, here more and there less.
  std::vector<std::uint8_t> wrong;
};

// Each vertex that was merged with another gets what that one has: `origin` one a vertex.
void restore(Ways& ways, const std::vector<Index>& origin);
void restore(Excess& excess, const std::vector<Index>& origin);

class StrainGauge {
 public:
  // Of the plate that `solver` has solved for, by moves of vertices so many rings apart at once. All
  // references must outlive it.
  StrainGauge(const FairingProblem& problem, ThinPlateSolver& solver, int rings_apart,
              const OnPart& on_part = {});

  // Throws too_large where the memory that is allowed does not hold the matrix beside the surface's
  // bytes, which are predicted.
  static void require_room(const FairingProblem& problem, int rings_apart, std::size_t surface);

  const CurveLoads& curves() const { return curves_; }
  // What strains: input vertices on pads, ascending, then the middles() of curves that are faired. The
  // matrix of their loads has one row and column each; on curves loads are the pulls D'D x, with D the
  // differences of the curves.
  const std::vector<Index>& vertices() const { return vertices_; }
  std::size_t on_pads() const { return on_pads_; }
  const LoadMatrix& matrix() const { return matrix_; }
  // Of each row: itself and its mirror images.
  const std::vector<std::vector<Index>>& images() const { return images_; }
  int solves() const { return solves_; }
  // Of a surface through these positions.
  Columns loads(const Loads& on_pads, const ControlPositions& control) const;

  Ways strain(const Loads& on_pads, const ControlPositions& control) const;
  Excess excess(const Loads& on_pads, const ControlPositions& control) const;
  // Of each row those within two rings that are as it is: on a curve, beside one or inside, and with
  // as many neighbours.
  std::vector<std::vector<Index>> of_same_star() const;

 private:
  using Kinds = std::vector<std::size_t>;
  Kinds kinds(bool by_neighbours) const;
  std::vector<std::vector<Index>> alike(const Kinds& kinds) const;
  void add_pulls();
  void find_images();
  std::vector<Index> row_of_vertices() const;
  Columns ways_of(Columns loads) const;
  Ways in_mesh_units(const Columns& ways) const;
  std::vector<double> lengths_of(const Columns& ways) const;
  std::vector<double> floors_of(const std::vector<double>& lengths, double floor) const;

  const FairingProblem& problem_;
  CurveLoads curves_;
  std::vector<Index> vertices_;
  std::size_t on_pads_ = 0;
  std::optional<CountedBytes> counted_;
  LoadMatrix matrix_;
  LoadMatrix pulls_;  // D'D of all control vertices
  Columns normals_;   // of each row; zero on curves
  std::vector<std::vector<Index>> images_;
  int solves_ = 0;
};

}  // namespace fairing
