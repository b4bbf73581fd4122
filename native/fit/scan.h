// SPDX-License-Identifier: GPL-3.0-or-later
// The points that a surface is fitted to, in working coordinates.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "base/types.h"
#include "fairing/control_positions.h"
#include "parallel/memory.h"
#include "parallel/workers.h"

namespace fairing {

// As the caller gives it, in world coordinates.
struct ScanInput {
  std::vector<double> coordinates;  // 3 a point
  std::vector<double> normals;      // 3 a point, outwards, of any length; zero: unknown. Or empty
  // Vertex ids of triangles, counter-clockwise seen from outside; or empty. Normals come from them where
  // none are given, and borders.
  std::vector<std::int64_t> triangles;
};

// Three hold a plane, and noise is in all.
constexpr std::size_t fewest_points = 10;

// Points in an order in which neighbours in space are near one another: their feet share cells, and memory.
struct Scan {
  Array<Vec3> point;
  Array<Index> given;             // the caller's number of each
  Array<Eigen::Vector3f> normal;  // of length one, or zero; or empty
  std::vector<Vec3> border;       // its points on borders of its triangles
  std::size_t size() const { return point.size(); }

  static constexpr std::int64_t bytes_a_point =
      sizeof(Vec3) + sizeof(Index) + sizeof(Eigen::Vector3f);
};

// Throws FairingError: bad_shape, index_out_of_range and non_finite for arrays that are no scan, or have
// too few points.
Scan make_scan(const ScanInput& input, const Frame& frame, Workers& workers);

// Throws FairingError(bad_shape) where the scan and the control mesh are not of one size, as in different
// units, or too far apart for nearest points to mean anything. Both in working coordinates.
void require_same_place(const Scan& scan, std::span<const Vec3> control, const Frame& frame);

// Three digits, for messages.
std::string length_text(double length);

}  // namespace fairing
