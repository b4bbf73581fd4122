// SPDX-License-Identifier: GPL-3.0-or-later
// The fairest surface near a scan: the thin plate, its control vertices free, on the forces of the scan's
// points (docs/python/fit.md).
#pragma once

#include "fairing/fair.h"
#include "fit/scan.h"

namespace fairing {

struct FitSettings {
  // Mesh units: the calmest surface with 95 % of the points within it; 0: none is given.
  double tolerance = 0;
  // How strongly points pull: 1 halves waves as long as the mean control edge; 0: chosen by points that
  // are held out.
  double weight = 0;
  std::vector<std::uint8_t> fixed;  // one an input vertex: stays where it is; or empty
};

// What is off; lengths in mesh units. Points are those of the scan, faces those of the input.
struct FitReport {
  Array<double> distances;               // of points, positive outside; NaN: no foot
  Array<std::int32_t> faces;             // where their feet are; -1: none
  double noise = 0;                      // root mean square of what is left, strays apart
  double weight = 0;                     // as FitSettings::weight
  double within = 0, largest = 0;        // 95 % of the covered points; all that are no outliers
  std::vector<double> coverage;          // of each face: the share that has points
  std::vector<std::int64_t> too_coarse;  // faces that want a split
  std::vector<std::int64_t> outliers;    // points
  std::vector<std::array<double, 2>> trials;  // weights tried, and what points held out were off
  int iterations = 0;
};

struct FitResult : FairResult {
  FitReport fit;
};

// As fair(). Throws FairingError, too, for scans that are none, far away, inside out, or too few points.
FitResult fit_scan(const PolygonMesh& mesh, const FairOptions& options, const ScanInput& scan,
                   const FitSettings& settings, Monitor& monitor);

}  // namespace fairing
