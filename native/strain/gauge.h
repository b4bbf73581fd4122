// SPDX-License-Identifier: GPL-3.0-or-later
// Converts loads to lengths: a load over the load of a unit move of the vertex alone is the
// distance by which the surface would move if the vertex were released. On curves it is the move
// that makes the curve's loads least (strain/curve_loads.h).
#pragma once

#include <optional>
#include <vector>

#include "fairing/systems.h"
#include "strain/curve_loads.h"
#include "strain/load_matrix.h"

namespace fairing {

// Moves of the surface, one for each input vertex, in mesh units, and their parts along the control
// mesh's normal (positive on its side; on curves the whole length). NaN at corners, at and next to
// ends of curves, and outside a region.
struct Ways {
  std::vector<Vec3> ways;
  std::vector<double> lengths;
};

// The vertex' own part of strain: without the effect of vertices that strain more
// (strain/excess.h), from loads with moments on borders (strain/border_moments.h).
struct Excess {
  Ways own;
  // What scatter explains, estimated by a median, which a few wrong vertices do not change.
  double floor = 0;
  // Per input vertex, nonzero if it is above the floor and stands out from its surroundings. A fair
  // shape strains between its vertices too.
  std::vector<std::uint8_t> wrong;
};

// Gives each merged vertex the values of the one it was merged with; `origin` per vertex.
void restore(Ways& ways, const std::vector<Index>& origin);
void restore(Excess& excess, const std::vector<Index>& origin);

class StrainGauge {
 public:
  // For the plate that `systems` have solved, with moves of vertices so many rings apart at once.
  // The problem must outlive this.
  StrainGauge(const FairingProblem& problem, FairingSystems& systems, int rings_apart,
              const OnPart& on_part = {});

  // Throws too_large if the memory limit does not hold the matrix beside the predicted bytes of the
  // surface.
  static void require_room(const FairingProblem& problem, int rings_apart, std::size_t surface);

  const CurveLoads& curves() const { return curves_; }
  // The rows: input vertices on pads, ascending, then the middles() of faired curves. The matrix of
  // loads has one row and column for each; on curves loads are D'D x, with D the differences of the
  // curves.
  const std::vector<Index>& vertices() const { return vertices_; }
  std::size_t on_pads() const { return on_pads_; }
  const LoadMatrix& matrix() const { return matrix_; }
  // Of each row: itself and its mirror images.
  const std::vector<std::vector<Index>>& images() const { return images_; }
  int solves() const { return solves_; }
  // Loads of a surface through these positions.
  Columns loads(const Loads& on_pads, const ControlPositions& control) const;

  Ways strain(const Loads& on_pads, const ControlPositions& control) const;
  Excess excess(const Loads& on_pads, const ControlPositions& control) const;

 private:
  // For each row the rows within two rings of the same kind: on a curve, beside one or inside.
  std::vector<std::vector<Index>> rows_of_same_kind() const;
  void add_curve_rows();
  std::vector<Index> row_of_vertices() const {
    return numbered(std::size_t(problem_.mesh.vertex_count()), vertices_);
  }
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
  LoadMatrix curve_matrix_;  // D'D of all control vertices
  Columns normals_;          // of each row; zero on curves
  std::vector<std::vector<Index>> images_;
  int solves_ = 0;
};

}  // namespace fairing
