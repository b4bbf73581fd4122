// SPDX-License-Identifier: GPL-3.0-or-later
// Mirror symmetries of a control mesh: planes, and the images of vertices, edges and faces.
#pragma once

#include <functional>
#include <memory>
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
    return !ring.empty() && turn[ring[0].face] == in_plane;
  }
  bool edge_in_plane(const ControlMesh& mesh, Index e) const {
    const auto& sides = mesh.edges[e].side;
    const Index side = sides[sides[0] < 0 ? 1 : 0];
    return turn[mesh.sides[side].face] == in_plane;
  }

  // Whether the image of an edge has the opposite direction.
  bool reverses(const ControlMesh& mesh, Index e) const {
    const auto image = std::size_t(edge[e]);
    return mesh.edges[image].vertex[0] != vertex[mesh.edges[e].vertex[0]];
  }
};

// Up to three mirrors, at right angles to each other, so that averaging by one keeps the symmetry of
// the others. Found once for a mesh and handed down; copies share the images.
struct Symmetry {
  using Holds = std::function<bool(const Mirror&)>;

  std::vector<std::shared_ptr<const Mirror>> mirrors{};

  // The mirrors that hold.
  Symmetry kept(const Holds& holds) const;
  // A vertex and its images, each once.
  std::vector<Index> images(Index v) const;
};

// All planes that may mirror the vertices, coordinate planes first; most do not. Positions as for
// find_symmetry.
std::vector<Plane> mirror_planes(const ControlMesh& mesh, double tolerance);

// The mirrors of the mesh with its features and its region; coordinate planes come first. `holds`
// decides last. Positions must be centred at the origin, with a bounding box of size one;
// `tolerance` is their rounding. May throw FairingError(cancelled).
Symmetry find_symmetry(const ControlMesh& mesh, double tolerance, const Symmetry::Holds& holds);

// Whether other positions of the vertices have the same mirror.
bool mirrors_positions(const ControlMesh& mesh, const Mirror& mirror,
                       std::span<const Vec3> positions, double tolerance);

}  // namespace fairing
