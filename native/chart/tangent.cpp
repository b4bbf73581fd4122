// SPDX-License-Identifier: GPL-3.0-or-later
// Tangent-plane charts: the linearly refined control mesh seen along its normal.
#include <Eigen/Geometry>
#include <cmath>

#include "chart/chart.h"

namespace fairing {
namespace {

// Directions of a face's lattice at its corner c (exact for a triangle, the bilinear map's tangents for a quad).
struct Corner {
  Vec3 along, up;  // to the next corner, to the previous one
};

Corner corner(const ControlMesh& mesh, const Face& face, int c) {
  const auto at = [&](int k) -> const Vec3& {
    return mesh.positions[std::size_t(face.vertex[std::size_t((k + face.size) % face.size)])];
  };
  return {at(c + 1) - at(c), at(c - 1) - at(c)};
}

// The same in the middle of side s: a quad's lattice is that of its parallelogram.
Corner middle(const ControlMesh& mesh, const Face& face, int s) {
  if (!face.quad()) return corner(mesh, face, s);
  const Corner here = corner(mesh, face, s), there = corner(mesh, face, (s + 2) % 4);
  return {0.5 * (here.along - there.along), 0.5 * (here.up - there.up)};
}

Vec3 any_orthogonal(const Vec3& n) {
  const Vec3 axis = std::abs(n.x()) < 0.6 ? Vec3::UnitX() : Vec3::UnitY();
  return n.cross(axis).normalized();
}

struct Frame {
  Vec3 x, y;
  explicit Frame(const Vec3& normal)
      : x(any_orthogonal(normal.normalized())), y(normal.normalized().cross(x)) {}
  Vec2 project(const Vec3& p) const { return {p.dot(x), p.dot(y)}; }
};

}  // namespace

Chart ChartMaker::tangent_vertex(Index v) const {
  const auto ring = mesh_.ring(v);
  Vec3 normal = Vec3::Zero();
  for (const Spoke& spoke : ring)
    if (spoke.face >= 0) {
      const Corner c = corner(mesh_, mesh_.faces[std::size_t(spoke.face)], spoke.corner);
      normal += c.along.cross(c.up);
    }
  Chart chart = exponential_vertex(v, flat_);
  if (normal.norm() == 0) return chart;  // no tangent plane there
  const Frame frame(normal);
  chart.ring.clear();
  for (const Spoke& spoke : ring) {
    const Edge& edge = mesh_.edges[std::size_t(spoke.edge)];
    const Index other = edge.vertex[spoke.outward ? 1 : 0];
    chart.ring.push_back(
        frame.project(mesh_.positions[std::size_t(other)] - mesh_.positions[std::size_t(v)]));
    if (spoke.face < 0) break;
    const Face& face = mesh_.faces[std::size_t(spoke.face)];
    if (face.quad()) {
      const Corner c = corner(mesh_, face, spoke.corner);
      chart.ring.push_back(frame.project(c.along + c.up));
    }
  }
  return chart;
}

Chart ChartMaker::tangent_edge(Index e) const {
  const Edge& edge = mesh_.edges[std::size_t(e)];
  Vec3 normal = Vec3::Zero();
  for (const Index s : edge.side)
    if (s >= 0) {
      const Side& side = mesh_.sides[std::size_t(s)];
      const Corner m = middle(mesh_, mesh_.faces[std::size_t(side.face)], side.local);
      normal += m.along.cross(m.up).normalized();
    }
  Chart chart = exponential_edge(e, flat_);
  if (!(normal.norm() > 1e-6)) return chart;
  const Frame frame(normal);
  const Vec2 forward = frame.project(mesh_.positions[std::size_t(edge.vertex[1])] -
                                     mesh_.positions[std::size_t(edge.vertex[0])]);
  chart.ring.clear();
  for (int h = 0; h < 2; ++h) {
    chart.ring.push_back(h == 0 ? forward : Vec2(-forward));
    if (edge.side[std::size_t(h)] < 0) continue;
    const Side& side = mesh_.sides[std::size_t(edge.side[std::size_t(h)])];
    const Face& face = mesh_.faces[std::size_t(side.face)];
    const Vec2 up = frame.project(middle(mesh_, face, side.local).up),
               along = h == 0 ? forward : Vec2(-forward);
    if (face.quad()) chart.ring.push_back(up + along);
    chart.ring.push_back(up);
    chart.ring.push_back(up - along);
  }
  return chart;
}

// Inside a face the lattice is flat already.
Chart ChartMaker::tangent_face(Index f) const { return exponential_face(f, flat_); }

}  // namespace fairing
