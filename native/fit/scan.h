// SPDX-License-Identifier: GPL-3.0-or-later
// The points to which a surface is fitted, in working coordinates.
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

// The caller's scan, in world coordinates.
struct ScanInput {
  std::vector<double> coordinates;  // 3 a point
  std::vector<double> normals;      // 3 a point, outwards, of any length; zero: unknown; or empty
  // Vertex ids of triangles, counter-clockwise seen from outside; or empty. They give the borders,
  // and normals if none are given.
  std::vector<std::int64_t> triangles;
};

// Three points define a plane, and all have noise.
constexpr std::size_t fewest_points = 10;

// Points sorted so that neighbours in space are close in memory: their feet share cells.
struct Scan {
  Array<Vec3> point;
  Array<Index> given;             // caller's number of each point
  Array<Eigen::Vector3f> normal;  // unit length or zero; or empty
  std::vector<Vec3> border;       // points on borders of the triangles
  std::size_t size() const { return point.size(); }

  static constexpr std::int64_t bytes_a_point =
      sizeof(Vec3) + sizeof(Index) + sizeof(Eigen::Vector3f);
};

// Throws FairingError: bad_shape (also for too few points), index_out_of_range, non_finite.
Scan make_scan(const ScanInput& input, const Frame& frame, Workers& workers);

// Throws FairingError(bad_shape) if the points lie on one line or in one place, if the sizes of scan
// and control mesh differ as those of different units do, or if they are too far apart. Both in working
// coordinates.
void require_same_place(const Scan& scan, std::span<const Vec3> control, const Frame& frame);

// A length as a place in a message, with three digits.
std::string length_text(double length);

}  // namespace fairing
