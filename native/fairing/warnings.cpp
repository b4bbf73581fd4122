// SPDX-License-Identifier: GPL-3.0-or-later
#include "fairing/warnings.h"

#include <cstdio>

#include "fairing/fixed_normals.h"
#include "hold/control_hold.h"
#include "parallel/memory_news.h"

namespace fairing {

void expect_memory(const Report& report) {
  if (MemoryNews* news = MemoryNews::current()) news->expect(report.predicted_bytes);
}

void warn_of_memory(const MemoryLedger& ledger, Report& report) {
  report.peak_bytes = ledger.peak();
  const MemoryNews* news = MemoryNews::current();
  if (!news || !news->told()) return;
  char text[200];
  std::snprintf(text, sizeof text,
                "This took %.3g MB where %.3g MB were predicted: some levels proved hard.",
                1e-6 * double(report.peak_bytes), 1e-6 * double(report.predicted_bytes));
  report.warnings.push_back({"MEMORY_EXCEEDED", text, {}, ElementKind::mesh});
}

void warn_unconverged(const LevelReport& level, const FairOptions& options, const std::string& of,
                      Report& report) {
  if (level.converged) return;
  char text[200];
  if (level.constraint_gap > gap_wanted)
    std::snprintf(
        text, sizeof text,
        "The tolerance is kept, but the energy may be %.1e above the least one, relative. "
        "The surface is usable; a smaller tolerance settles sooner.",
        level.constraint_gap);
  else if (level.normal_angle > largest_angle_left)
    std::snprintf(
        text, sizeof text,
        "Fixed normals have not settled after %d corrections: up to %.2g degrees are left. "
        "The surface is usable; fewer normals, or nearer to the mesh's own, settle sooner.",
        level.pad_corrections, level.normal_angle / degree);
  else if (level.pad_corrections > 0 && level.residual <= options.relative_residual)
    std::snprintf(text, sizeof text,
                  "The loads on pads have not settled after %d corrections: %.1e of them is still "
                  "changing. The surface is usable; a smaller pad_size settles sooner.",
                  level.pad_corrections, level.pad_force);
  else
    std::snprintf(text, sizeof text,
                  "The solver stopped after %d iterations at a relative residual of %.1e (target: "
                  "%.1e). The surface is usable.",
                  level.iterations, level.residual, options.relative_residual);
  report.warnings.push_back({"NOT_CONVERGED", of + text, {}, ElementKind::mesh});
}

}  // namespace fairing
