// SPDX-License-Identifier: GPL-3.0-or-later
// The fairest surface near a scan: the thin plate with free control vertices, under the forces of
// the scan's points (docs/python/fit.md).
#pragma once

#include "fairing/fair.h"
#include "fit/scan.h"

namespace fairing {

struct FitSettings {
  // Mesh units: the smoothest surface that keeps 95 % of the points within this; 0: not given.
  double tolerance = 0;
  // Weight of points: 1 halves waves of a mean control edge; 0: chosen by held-out points.
  double weight = 0;
  std::vector<std::uint8_t> fixed;  // one for each input vertex: it stays in place; or empty
};

// Deviations in mesh units. Points are those of the scan, faces those of the input.
struct FitReport {
  Array<double> distances;                    // of points, positive outside; NaN: no foot
  Array<std::int32_t> faces;                  // of the feet; -1: none
  double noise = 0;                           // root mean square of the residuals without outliers
  double weight = 0;                          // as FitSettings::weight
  double within = 0, largest = 0;             // of 95 % of the covered points; of all but outliers
  std::vector<double> coverage;               // share of each face with points; NaN: mended away
  std::vector<std::int64_t> too_coarse;       // faces to split
  std::vector<std::int64_t> outliers;         // points
  std::vector<std::array<double, 2>> trials;  // weights tried, and the error at held-out points
  int iterations = 0;
};

struct FitResult : FairResult {
  FitReport fit;
};

// As fair(). Also throws FairingError for scans with too few points, far away, or inside out.
FitResult fit_scan(const PolygonMesh& mesh, const FairOptions& options, const ScanInput& scan,
                   const FitSettings& settings, Monitor& monitor);

}  // namespace fairing
