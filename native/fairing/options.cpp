// SPDX-License-Identifier: GPL-3.0-or-later
#include "fairing/options.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <type_traits>

#include "base/error.h"
#include "base/roundoff.h"
#include "fairing/settings.h"
#include "parallel/memory.h"

namespace fairing {
namespace {

[[noreturn]] void refuse(const std::string& message, std::vector<std::int64_t> elements = {}) {
  throw FairingError(ErrorCode::bad_option, message, std::move(elements));
}

void in_range(const char* option, double value, Range range) {
  if (value >= range.low && value <= range.high) return;
  char text[120];
  if (range.high >= any_length.high)
    std::snprintf(text, sizeof text, "%s is %g; it must be %g or more.", option, value, range.low);
  else
    std::snprintf(text, sizeof text, "%s is %g; it must be from %g to %.10g.", option, value,
                  range.low, range.high);
  refuse(text);
}

// Checks for one number a vertex, from 0 to `most`, and not NaN.
void check_per_vertex(const PolygonMesh& mesh, const char* option,
                      const std::vector<double>& values, double most) {
  if (std::int64_t(values.size()) != mesh.vertex_count())
    refuse(std::string(option) + " has " + std::to_string(values.size()) + " entries for " +
           std::to_string(mesh.vertex_count()) + " vertices; give one for each vertex.");
  std::vector<std::int64_t> bad;
  for (std::size_t v = 0; v < values.size(); ++v)
    if (!(values[v] >= 0 && values[v] <= most)) bad.push_back(std::int64_t(v));
  if (!bad.empty())
    refuse(std::string(option) + " must be " + up_to(most) + "; see vertex " +
               std::to_string(bad[0]) + ".",
           bad);
}

void check_values(const PolygonMesh& mesh, const FairOptions& o) {
  for_each_setting([&](const char* option, auto range, auto... member) {
    if constexpr (std::is_same_v<decltype(range), Range>)
      in_range(option, double((o.*....*member)), range);
    if constexpr (std::is_same_v<decltype(range), PerVertex>)
      if (!(o.*....*member).empty()) check_per_vertex(mesh, option, (o.*....*member), range.most);
  });
}

void check_normals(const PolygonMesh& mesh, const FairOptions& o) {
  if (o.normals.empty()) return;
  if (std::int64_t(o.normals.size()) != 3 * mesh.vertex_count())
    refuse("normals has " + std::to_string(o.normals.size() / 3) + " rows for " +
           std::to_string(mesh.vertex_count()) + " vertices; give one for each vertex.");
  std::vector<std::int64_t> bad;
  for (std::size_t i = 0; i < o.normals.size(); i += 3)
    if (std::any_of(&o.normals[i], &o.normals[i] + 3, [](double n) { return std::isinf(n); }))
      bad.push_back(std::int64_t(i / 3));
  if (!bad.empty())
    throw FairingError(
        ErrorCode::bad_option,
        "{vertex} {has|have} an infinite normal; give finite numbers, or NaN for none.", bad,
        ElementKind::vertex);
}

// With 10 all 14 cages of benchmarks/limits.py have less energy than Subdivision Surface, and rims
// turn by at most 0.3 % more. With 3 the fox intersects itself; with 30 two have larger angles.
constexpr double tightest = 10;

}  // namespace

// By default errors remain that are invisible, as with the thin plate.
CurveScheme FairOptions::curve_scheme() const {
  return {1 << levels, paper.metric_exponent(metric_exponent),
          interpolation == Interpolation::limit ? ChainEnds::natural : ChainEnds::parabolic};
}

double FairOptions::step_tolerance_wanted() const {
  if (step_tolerance > 0) return step_tolerance;
  // in sizes of the mesh; smaller with the residual, down to single precision
  const double least = std::min(solve.relative_residual, SolveOptions().relative_residual);
  return std::max(0.1 * least, single_roundoff);
}

double FairOptions::tolerance_of(std::size_t v) const {
  if (interpolation != Interpolation::approximate) return 0;
  if (tolerance.size() > 1) return tolerance[v];
  return tolerance[0] > 0 ? tolerance[0] : weights.empty() ? 0 : INFINITY;
}

bool FairOptions::has_tolerance() const {
  return interpolation == Interpolation::approximate &&
         std::any_of(tolerance.begin(), tolerance.end(),
                     [](double t) { return t > 0 && std::isfinite(t); });
}

bool FairOptions::has_normal(std::size_t v) const {
  if (3 * v + 2 >= normals.size()) return false;
  const double x = normals[3 * v], y = normals[3 * v + 1], z = normals[3 * v + 2];
  return !std::isnan(x + y + z) && (x != 0 || y != 0 || z != 0);
}

bool FairOptions::has_normals() const {
  for (std::size_t v = 0; v < normals.size() / 3; ++v)
    if (has_normal(v)) return true;
  return false;
}

std::size_t FairOptions::bytes_allowed() const {
  return memory_limit ? memory_limit : physical_memory() / 4 * 3;
}

double limit_penalty(double limit) { return tightest * std::pow(limit, 4); }

void check_options(const PolygonMesh& mesh, const FairOptions& o) {
  check_values(mesh, o);
  if (o.tolerance.size() == 1)
    in_range("tolerance", o.tolerance[0], any_length);
  else
    check_per_vertex(mesh, "tolerance", o.tolerance, no_limit);
  check_edge_values("edge_sharpness", mesh.vertex_count(), o.sharpness.edges, sharp_for_ever);
  check_edge_values("soft_creases", mesh.vertex_count(), o.features.soft_creases, 1);
  check_normals(mesh, o);
  for (const Conflict& conflict : conflicts)
    if (conflict.is_in(o)) refuse(conflict.message);
}

}  // namespace fairing
