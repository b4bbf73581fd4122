// SPDX-License-Identifier: GPL-3.0-or-later
// The table of settings: name, range and member of FairOptions for each. The binding and
// check_options() read it; options.h documents the members.
#pragma once

#include "fairing/options.h"

namespace fairing {

// Range of a number, both ends included.
struct Range {
  double low, high;
};

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
  visit("weights", any, &O::weights);
  visit("limit", unit_interval, &O::limit);
  visit("edge_sharpness", any, &O::sharpness, &Sharpness::edges);
  visit("vertex_sharpness", any, &O::sharpness, &Sharpness::vertices);
  visit("epsilon", any_length, &O::paper, &PaperOptions::epsilon);
  visit("pad_size", unit_interval, &O::pad_size);
  visit("normals", any, &O::normals);
  visit("tension", unit_interval, &O::tension);
  visit("method", any, &O::paper, &PaperOptions::method);
  visit("relative_residual", Range{1e-13, 0.5}, &O::solve, &SolveOptions::relative_residual);
  visit("max_iterations", positive_count, &O::solve, &SolveOptions::max_iterations);
  visit("smoother_degree", Range{0, 1000}, &O::solve, &SolveOptions::smoother_degree);
  visit("sweeps", Range{0, 1e6}, &O::paper, &PaperOptions::sweeps);
  visit("threads", Range{0, 1024}, &O::threads);
  visit("memory_limit", any, &O::memory_limit);
  visit("measure", any, &O::measure);
}

}  // namespace fairing
