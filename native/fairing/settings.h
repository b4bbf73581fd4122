// SPDX-License-Identifier: GPL-3.0-or-later
// The table of settings: name, range and member of FairOptions for each; and which exclude one
// another. The binding, check_options() and mending read it; options.h documents the members.
#pragma once

#include <limits>

#include "fairing/options.h"

namespace fairing {

// Range of a number, both ends included.
struct Range {
  double low, high;
};

// One number a control vertex, from 0 to `most`; or none at all. Vertices that are merged get the
// largest of theirs.
struct PerVertex {
  double most;
};
constexpr double no_limit = std::numeric_limits<double>::infinity();

// For values that are not numbers or are checked with the mesh.
struct AnyValue {};

constexpr Range unit_interval{0, 1}, any_length{0, 1e300}, positive_count{1, 2147483647};

// visit(name, range, members...): the last member holds the value, in the struct of the one before.
template <class Visit>
void for_each_setting(Visit&& visit) {
  using O = FairOptions;
  constexpr AnyValue any;
  visit("levels", Range{0, most_levels}, &O::levels);
  visit("energy", any, &O::energy);
  visit("step_tolerance", Range{0, 0.1}, &O::step_tolerance);
  visit("max_steps", positive_count, &O::max_steps);
  visit("chart", any, &O::paper, &PaperOptions::chart);
  visit("metric_exponent", unit_interval, &O::metric_exponent);
  visit("chart_blend", unit_interval, &O::paper, &PaperOptions::chart_blend);
  visit("crease_edges", any, &O::features, &FeatureOptions::crease_edges);
  visit("flat_faces", any, &O::features, &FeatureOptions::flat_faces);
  visit("soft_creases", any, &O::features, &FeatureOptions::soft_creases);
  visit("corner_vertices", any, &O::features, &FeatureOptions::corner_vertices);
  visit("crease_angle", any, &O::features, &FeatureOptions::crease_angle);
  visit("corner_angle", any, &O::features, &FeatureOptions::corner_angle);
  visit("boundary", any, &O::features, &FeatureOptions::boundary);
  visit("boundary_edges", any, &O::features, &FeatureOptions::boundary_edges);
  visit("joint", any, &O::features, &FeatureOptions::region, &RegionOptions::joint);
  visit("repair", any, &O::repair);
  visit("weld", Range{-1e300, 1e300}, &O::weld);  // below 0: none
  visit("interpolation", any, &O::interpolation);
  visit("tolerance", any, &O::tolerance);
  visit("weights", PerVertex{no_limit}, &O::weights);
  visit("limit", unit_interval, &O::limit);
  visit("edge_sharpness", any, &O::sharpness, &Sharpness::edges);
  visit("vertex_sharpness", PerVertex{sharp_for_ever}, &O::sharpness, &Sharpness::vertices);
  visit("epsilon", any_length, &O::paper, &PaperOptions::epsilon);
  visit("pad_size", unit_interval, &O::pad_size);
  visit("normals", any, &O::normals);
  visit("tension", unit_interval, &O::membrane, &MembraneOptions::tension);
  visit("method", any, &O::paper, &PaperOptions::method);
  visit("relative_residual", Range{1e-13, 0.5}, &O::solve, &SolveOptions::relative_residual);
  visit("max_iterations", positive_count, &O::solve, &SolveOptions::max_iterations);
  visit("smoother_degree", Range{0, 1000}, &O::solve, &SolveOptions::smoother_degree);
  visit("sweeps", Range{0, 1e6}, &O::paper, &PaperOptions::sweeps);
  visit("threads", Range{0, 1024}, &O::threads);
  visit("memory_limit", any, &O::memory_limit);
  visit("measure", any, &O::measure);
}

// What some energies or other settings exclude.
struct Conflict {
  bool (*is_in)(const FairOptions&);
  const char* message;
};

inline constexpr Conflict conflicts[] = {
    {[](const FairOptions& o) { return o.weld >= 0 && o.repair != Repair::mend; },
     "weld is for repair=\"mend\"; a mesh that is refused or faired as it is has none."},
    {[](const FairOptions& o) { return o.energy != Energy::thin_plate && o.has_normals(); },
     "normals are for the thin plate only; use energy=\"thin_plate\", or free the normals."},
    {[](const FairOptions& o) {
       return o.energy != Energy::thin_plate && !o.features.flat_faces.empty();
     },
     "flat_faces are for the thin plate only, other energies leave waves in them; use "
     "energy=\"thin_plate\", or leave flat_faces out."},
    {[](const FairOptions& o) {
       return o.interpolation == Interpolation::limit && !o.features.flat_faces.empty();
     },
     "flat_faces keep their own planes, in which limit positions are not; use "
     "interpolation=\"exact\", or leave flat_faces out."},
    {[](const FairOptions& o) {
       return o.energy == Energy::minimum_variation && o.membrane.tension > 0;
     },
     "tension cannot be used with minimum variation; use energy=\"thin_plate\" or "
     "energy=\"total_curvature\", or set tension to 0."},
    {[](const FairOptions& o) { return o.energy != Energy::thin_plate && o.paper.epsilon > 0; },
     "epsilon is for the thin plate; under another energy use interpolation=\"approximate\" "
     "with a tolerance."},
    {[](const FairOptions& o) {
       return o.paper.method == Method::back_leg && o.energy != Energy::thin_plate;
     },
     "method=\"back_leg\" is for the thin plate only; use multigrid for other energies."},
    {[](const FairOptions& o) {
       return o.paper.method == Method::back_leg &&
              (o.interpolation == Interpolation::approximate || o.paper.epsilon > 0);
     },
     "method=\"back_leg\" interpolates exactly; use multigrid for tolerance, weights or epsilon."},
    {[](const FairOptions& o) { return o.paper.method == Method::back_leg && o.has_normals(); },
     "method=\"back_leg\" solves without couples; use multigrid to fix normals."},
    {[](const FairOptions& o) {
       return !o.weights.empty() && o.interpolation != Interpolation::approximate;
     },
     "weights are for interpolation=\"approximate\"; other interpolations have none."},
};

}  // namespace fairing
