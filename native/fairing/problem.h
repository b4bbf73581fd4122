// SPDX-License-Identifier: GPL-3.0-or-later
// What all surfaces of one control mesh share and what never changes: the mesh, its positions,
// charts and stencils, unknowns, constraints, threads.
#pragma once

#include <memory>
#include <vector>

#include "constraints/control_constraints.h"
#include "fairing/control_positions.h"
#include "fairing/fixed_normals.h"
#include "fairing/held_positions.h"
#include "fairing/options.h"
#include "fairing/report.h"
#include "mesh/symmetry.h"
#include "paper/charts.h"
#include "stencil/stencils.h"

namespace fairing {

struct FairingProblem {
  FairOptions options;
  std::shared_ptr<Workers> workers;
  ControlMesh mesh;  // in working coordinates
  double exponent;   // of the control metric
  Unknowns unknowns;
  ChosenNormals normals;
  HeldPositions held{};

  // The frame of the positions from which charts and stencils are made.
  Frame frame{};
  ControlPositions basis{};
  MeshUnits units{};
  Stencils stencils{};
  // Of all that the surface depends on, in working coordinates.
  Symmetry symmetry{};
  VertexWeights start_weights{};  // of control vertices

  std::unique_ptr<ChartMaker> charts() const { return make_charts(mesh, exponent, options.paper); }

  // Other positions of the input's vertices, 3 numbers each in world coordinates, with the curve
  // parameters of the basis.
  ControlPositions control_positions(std::span<const double> coordinates) const;
  // One of the options' shapes, with its handed curves.
  ControlPositions shape_positions(std::size_t shape) const;
  // The part of the symmetry that these positions have too.
  Symmetry symmetry_of(const ControlPositions& control) const;
  // The constraints of the control vertices at these positions, with weights in this unit.
  // `control` must outlive them.
  ControlConstraints constraints_of(const ControlPositions& control, double unit) const {
    if (options.interpolation != Interpolation::approximate)
      return {mesh, control.working, unknowns};
    return {mesh, control.working, unknowns, weights_with_copies(), unit, working_tolerances()};
  }

 private:
  ControlPositions about(std::span<const double> coordinates, const HandedCurves& handed,
                         std::size_t shape) const;
  // Per input vertex and copy, in working coordinates; infinity: none. May be empty.
  std::vector<double> working_tolerances() const;
  std::vector<double> weights_with_copies() const;
};

// The input checks of fair(): throws for defects, writes warnings into `report`.
void check_input(const PolygonMesh& input, const FairOptions& options, Stopwatch& watch,
                 Report& report);

// Checks the input and makes the problem. Warnings and sizes go to `report`. The memory that the
// spans of `options` refer to must outlive the problem. Throws FairingError and bad_alloc.
std::unique_ptr<const FairingProblem> make_problem(const PolygonMesh& input,
                                                   const FairOptions& options, Stopwatch& watch,
                                                   Report& report);

// The same with other positions of the input's vertices: new charts, stencils and curves; faces,
// splits and creases stay.
std::unique_ptr<const FairingProblem> make_problem_about(const PolygonMesh& input,
                                                         const FairingProblem& like,
                                                         Stopwatch& watch);

}  // namespace fairing
