// SPDX-License-Identifier: GPL-3.0-or-later
// Mirror symmetries of a control mesh: planes, and the images of vertices, edges and faces.
#pragma once

#include <functional>
#include <vector>

#include "mesh/control_mesh.h"

namespace fairing {

struct Plane {
  Vec3 normal;    // of length one
  double offset;  // of the plane's points along the normal

  // How far the image of a vertex may be off during the search, in tolerances: the plane is found
  // from two vertices, whose rounding tilts it.
  static constexpr double search_reach = 100;

  Vec3 image(const Vec3& p) const { return p - 2 * (normal.dot(p) - offset) * normal; }
};

struct Mirror {
  Plane plane;
  std::vector<Index> vertex, edge, face;  // the images; vertices without faces are their own
  std::vector<std::int8_t> turn;  // corner c of a face has its image at corner (turn - c) mod size
  // In place of a turn: the face and its whole sheet lie in the plane. It is its own image, corner
  // by corner.
  static constexpr std::int8_t in_plane = -1;

  bool vertex_in_plane(const ControlMesh& mesh, Index v) const {
    const auto ring = mesh.ring(v);
    return !ring.empty() && turn[std::size_t(ring[0].face)] == in_plane;
  }
  bool edge_in_plane(const ControlMesh& mesh, Index e) const {
    const auto& sides = mesh.edges[std::size_t(e)].side;
    const Index side = sides[sides[0] < 0 ? 1 : 0];
    return turn[std::size_t(mesh.sides[std::size_t(side)].face)] == in_plane;
  }

  // Whether the image of an edge has the opposite direction.
  bool reverses(const ControlMesh& mesh, Index e) const {
    const auto image = std::size_t(edge[std::size_t(e)]);
    return mesh.edges[image].vertex[0] != vertex[std::size_t(mesh.edges[std::size_t(e)].vertex[0])];
  }
};

// The mirrors that a surface keeps, of those that its control mesh has; not owned.
using Mirrors = std::vector<const Mirror*>;

// All planes that may mirror the vertices, coordinate planes first; most do not. Positions as for
// find_mirrors.
std::vector<Plane> mirror_planes(const ControlMesh& mesh, double tolerance);

// Up to three mirrors of the mesh with its features and its region, at right angles to each other,
// so that averaging by one keeps the symmetry of the others; coordinate planes come first. `holds`
// decides last. Positions must be centred at the origin, with a bounding box of size one;
// `tolerance` is their rounding.
std::vector<Mirror> find_mirrors(const ControlMesh& mesh, double tolerance,
                                 const std::function<bool(const Mirror&)>& holds);

// Whether other positions of the vertices have the same mirror.
bool mirrors_positions(const ControlMesh& mesh, const Mirror& mirror,
                       std::span<const Vec3> positions, double tolerance);

}  // namespace fairing
