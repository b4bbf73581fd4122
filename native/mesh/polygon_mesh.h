// SPDX-License-Identifier: GPL-3.0-or-later
// The input as plain arrays, not owned, unchecked before check() (mesh/validate/check.h).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace fairing {

// Face f has the corners corners[offsets[f]] … corners[offsets[f + 1] - 1], counter-clockwise.
struct PolygonMesh {
  std::span<const double> coordinates;    // 3 per vertex: x y z
  std::span<const std::int64_t> corners;  // vertex ids, face after face
  std::span<const std::int64_t> offsets;  // faces + 1, ascending from 0

  std::int64_t vertex_count() const { return std::int64_t(coordinates.size()) / 3; }
  std::int64_t face_count() const { return offsets.empty() ? 0 : std::int64_t(offsets.size()) - 1; }
  std::span<const std::int64_t> face(std::int64_t f) const {
    return corners.subspan(std::size_t(offsets[f]), std::size_t(offsets[f + 1] - offsets[f]));
  }
};

// The same, owning its face arrays.
struct OwnedPolygonMesh {
  std::vector<double> coordinates;
  std::vector<std::int64_t> corners;
  std::vector<std::int64_t> offsets{0};

  PolygonMesh view() const { return {coordinates, corners, offsets}; }
};

}  // namespace fairing
