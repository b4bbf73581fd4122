// SPDX-License-Identifier: GPL-3.0-or-later
#include "fit/scan.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>

#include "base/error.h"
#include "base/points.h"
#include "base/roundoff.h"
#include "mesh/counting_sort.h"
#include "parallel/cancel.h"
#include "parallel/reductions.h"

namespace fairing {
namespace {

void require_arrays(const ScanInput& input) {
  const std::size_t numbers = input.coordinates.size();
  if (numbers == 0)
    throw FairingError(ErrorCode::bad_shape,
                       {"The scan has no points.", "Give the points to fit the surface to."});
  if (numbers < 3 * fewest_points)
    throw FairingError(
        ErrorCode::bad_shape,
        {"The scan has " + std::to_string(numbers / 3) + (numbers == 3 ? " point." : " points."),
         "A surface takes some points a face of the control mesh."});
  if (!input.normals.empty() && input.normals.size() != numbers)
    throw FairingError(ErrorCode::bad_shape,
                       {"The scan has another number of normals than of points.",
                        "Give one normal a point, or none at all."});
  for (const std::int64_t v : input.triangles)
    if (v < 0 || 3 * v >= std::int64_t(numbers))
      throw FairingError(ErrorCode::index_out_of_range,
                         {"A triangle of the scan has corner " + std::to_string(v) +
                              ", and the scan has " + std::to_string(numbers / 3) + " points.",
                          "Corners of triangles are numbers of points, from 0 on."});
  for (const std::vector<double>* const values : {&input.coordinates, &input.normals}) {
    const auto bad =
        std::find_if_not(values->begin(), values->end(), [](double x) { return std::isfinite(x); });
    if (bad == values->end()) continue;
    const char* const what = values == &input.normals ? "The normal of point " : "Point ";
    throw FairingError(
        ErrorCode::non_finite,
        {what + std::to_string((bad - values->begin()) / 3) + " of the scan is not finite.",
         "Leave out points whose coordinates are infinite or not a number."});
  }
}

// Area-weighted, of unit length or zero, in the order of `given`.
Array<Eigen::Vector3f> normals_of(const ScanInput& input, const Array<Index>& given) {
  const std::size_t count = input.coordinates.size() / 3;
  Array<Eigen::Vector3f> out;
  if (input.normals.empty() && input.triangles.empty()) return out;
  std::vector<Vec3> sum;
  if (input.normals.empty()) {
    sum.assign(count, Vec3::Zero());
    for (std::size_t t = 0; t + 2 < input.triangles.size(); t += 3) {
      stop_if_cancelled(t / 3);
      Vec3 corner[3];
      for (std::size_t k = 0; k < 3; ++k)
        corner[k] = point_at(input.coordinates, input.triangles[t + k]);
      const Vec3 normal = (corner[1] - corner[0]).cross(corner[2] - corner[0]);
      for (std::size_t k = 0; k < 3; ++k) sum[input.triangles[t + k]] += normal;
    }
  }
  out.resize(count);
  for (std::size_t p = 0; p < count; ++p) {
    const Vec3 normal = sum.empty() ? point_at(input.normals, given[p]) : sum[given[p]];
    out[p] = unit_or_zero(normal).cast<float>();
  }
  return out;
}

// Ends of edges with one triangle.
std::vector<std::int64_t> border_of(const std::vector<std::int64_t>& triangles) {
  std::vector<std::array<std::int64_t, 2>> sides;
  sides.reserve(triangles.size());
  for (std::size_t t = 0; t + 2 < triangles.size(); t += 3)
    for (std::size_t k = 0; k < 3; ++k) {
      const std::int64_t a = triangles[t + k], b = triangles[t + (k + 1) % 3];
      sides.push_back({std::min(a, b), std::max(a, b)});
    }
  stop_if_cancelled();
  std::sort(sides.begin(), sides.end());
  std::vector<std::int64_t> out;
  for (std::size_t begin = 0, end = 0; begin < sides.size(); begin = end) {
    while (end < sides.size() && sides[end] == sides[begin]) ++end;
    if (end - begin > 1) continue;
    for (const std::int64_t v : sides[begin]) out.push_back(v);
  }
  std::sort(out.begin(), out.end());
  out.erase(std::unique(out.begin(), out.end()), out.end());
  return out;
}

Eigen::AlignedBox3d box_of(std::span<const Vec3> points) {
  Eigen::AlignedBox3d box;
  for (const Vec3& p : points) box.extend(p);
  return box;
}

// Numbers of points sorted by boxes, 16 along each axis of their bounding box, in Morton order
// [Morton 1966], so that most boxes follow an adjacent one.
Array<Index> in_order_of_place(const ScanInput& input) {
  constexpr int bits = 4;  // a box has some hundred cells of a fine level, which stay in the cache
  const std::size_t count = input.coordinates.size() / 3;
  const auto at = [&](std::size_t p) { return point_at(input.coordinates, std::int64_t(p)); };
  Eigen::AlignedBox3d box;
  for (std::size_t p = 0; p < count; ++p) box.extend(at(p));
  const Vec3 size = box.sizes().cwiseMax(std::numeric_limits<double>::min());
  const auto key = [&](std::size_t p) {
    const Vec3 share = (at(p) - box.min()).cwiseQuotient(size) * double((1 << bits) - 1);
    std::size_t code = 0;
    for (int b = bits - 1; b >= 0; --b)
      for (int a = 0; a < 3; ++a) code = 2 * code + ((std::size_t(share[a]) >> b) & 1);
    return code;
  };
  CountingSort<Index> sorted(std::size_t(1) << (3 * bits), count, key,
                             [](std::size_t p) { return Index(p); });
  Array<Index> out;
  out.reserve(count);
  for (std::size_t k = 0; k < sorted.keys(); ++k)
    for (const Index p : sorted.of(k)) out.push_back(p);
  return out;
}

// Points in one place or on one line, but for the rounding of single precision, are of no surface.
void require_extent(const Scan& scan) {
  Vec3 mean = Vec3::Zero();
  double largest = 0;
  for (const Vec3& p : scan.point) {
    mean += p / double(scan.size());
    largest = std::max(largest, p.lpNorm<Eigen::Infinity>());
  }
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  for (const Vec3& p : scan.point)
    spread += (p - mean) * (p - mean).transpose() / double(scan.size());
  const Vec3 squares = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(spread).eigenvalues();
  const double rounding = std::pow(largest * single_roundoff, 2);
  if (squares[1] > rounding) return;
  throw FairingError(ErrorCode::bad_shape,
                     {squares[2] > rounding ? "All points of the scan lie on one line."
                                            : "All points of the scan lie in one place.",
                      "A surface needs points that are spread over it."});
}

}  // namespace

std::string length_text(double length) {
  char text[32];
  std::snprintf(text, sizeof(text), "{length:%.3g}", length);
  return text;
}

Scan make_scan(const ScanInput& input, const Frame& frame, Workers& workers) {
  require_arrays(input);
  Scan scan;
  scan.given = in_order_of_place(input);
  scan.point.resize(scan.given.size());
  for_each_index(workers, scan.size(), [&](std::size_t p) {
    scan.point[p] = frame.to_working(point_at(input.coordinates, scan.given[p]));
  });
  scan.normal = normals_of(input, scan.given);
  for (const std::int64_t v : border_of(input.triangles))
    scan.border.push_back(frame.to_working(point_at(input.coordinates, v)));
  return scan;
}

void require_same_place(const Scan& scan, std::span<const Vec3> control, const Frame& frame) {
  // Ratio of sizes from which units differ. A scan of a part, and a cage with a part that is not
  // scanned, have smaller ratios; metres, millimetres and inches have larger ones.
  constexpr double other_unit = 20;
  require_extent(scan);
  const Eigen::AlignedBox3d cage = box_of(control), box = box_of(scan.point);
  const double ratio = box.diagonal().norm() / cage.diagonal().norm();
  if (ratio > other_unit || ratio * other_unit < 1)
    throw FairingError(
        ErrorCode::bad_shape,
        {"The scan measures " + length_text(frame.scale * box.diagonal().norm()) +
             " and the control mesh " + length_text(frame.scale * cage.diagonal().norm()) +
             " from corner to corner.",
         "Scale one of them: are their units of length the same?"});
  const Vec3 apart = (box.min() - cage.max()).cwiseMax(cage.min() - box.max());
  if (apart.maxCoeff() > 0)
    throw FairingError(ErrorCode::bad_shape,
                       {"The scan lies beside the control mesh, " +
                            length_text(frame.scale * apart.cwiseMax(0).norm()) + " away from it.",
                        "Move one onto the other."});
}

}  // namespace fairing
