// SPDX-License-Identifier: GPL-3.0-or-later
// What all surfaces of one control mesh have in common, and nothing changes once it is made: the
// mesh, its positions, charts and stencils, what is unknown and what holds it, threads.
#pragma once

#include <memory>
#include <vector>

#include "constraints/control_constraints.h"
#include "fairing/control_positions.h"
#include "fairing/fixed_normals.h"
#include "fairing/held_positions.h"
#include "fairing/options.h"
#include "fairing/report.h"
#include "fairing/symmetry.h"
#include "paper/charts.h"
#include "stencil/stencils.h"

namespace fairing {

struct FairingProblem {
  FairOptions options;
  std::shared_ptr<Workers> workers;
  ControlMesh mesh;  // in working coordinates
  double exponent;   // of the metric
  Unknowns unknowns;
  ChosenNormals normals;
  HeldPositions held{};

  // Of the positions that charts and stencils are made about.
  Frame frame{};
  ControlPositions basis{};
  MeshUnits units{};
  Stencils stencils{};
  std::vector<Mirror> mirrors{};
  VertexWeights start_weights{};  // of control vertices

  std::unique_ptr<ChartMaker> charts() const { return make_charts(mesh, exponent, options.paper); }

  // Other positions of the input's vertices, 3 numbers each in world coordinates, with the basis'
  // parameters of curves.
  ControlPositions control_positions(std::span<const double> coordinates) const;
  // Of one of the options' shapes, with the curves that are handed down for it.
  ControlPositions shape_positions(std::size_t shape) const;
  // The mirror symmetries that the mesh has with these positions too.
  Mirrors mirrors_of(const ControlPositions& control) const {
    return kept_by(control, mesh, frame, mirrors);
  }
  // What holds control vertices about these positions; weights in this unit. `control` must outlive
  // it.
  ControlConstraints constraints_of(const ControlPositions& control, double unit) const {
    if (options.interpolation != Interpolation::approximate)
      return {mesh, control.working, unknowns};
    return {mesh, control.working, unknowns, weights_with_copies(), unit, working_tolerances()};
  }

 private:
  ControlPositions about(std::span<const double> coordinates, const HandedCurves& handed,
                         std::size_t shape) const;
  // One an input vertex and copy: in working coordinates, infinity: none; the caller's, or empty.
  std::vector<double> working_tolerances() const;
  std::vector<double> weights_with_copies() const;
};

// The checks of fair() alone: throws what is wrong with a mesh, and puts warnings into `report`.
void check_input(const PolygonMesh& input, const FairOptions& options, Stopwatch& watch,
                 Report& report);

// Checks all input, and makes the problem about its positions. Warnings and sizes go to `report`.
// What the spans of `options` show must outlive the problem. Throws FairingError and bad_alloc.
std::unique_ptr<const FairingProblem> make_problem(const PolygonMesh& input,
                                                   const FairOptions& options, Stopwatch& watch,
                                                   Report& report);

// The same about other positions of the input's vertices: charts, stencils, curves. Faces, splits and
// creases stay.
std::unique_ptr<const FairingProblem> make_problem_about(const PolygonMesh& input,
                                                         const FairingProblem& like,
                                                         Stopwatch& watch);

}  // namespace fairing
