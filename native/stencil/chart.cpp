// SPDX-License-Identifier: GPL-3.0-or-later
#include "stencil/chart.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace fairing {
namespace {

constexpr double full_turn = 2 * std::numbers::pi;

Vec2 polar(double radius, double angle) {
  return {radius * std::cos(angle), radius * std::sin(angle)};
}

// A point's share of the face's area at unit spacing, for one corner of one cell.
double corner_share(const Face& face, const FlatFace& flat) { return flat.area / face.size; }

// The row of the face on one side of an edge point, front to back, in a frame whose x axis runs
// along the side. The face is stretched along the edge until its side is as long as the edge: were
// the two rows and the edge spaced differently, every function with a slope along the edge would
// seem to twist, the more the finer the grid.
void append_row(const Face& face, const FlatFace& flat, int s, double length, bool turned,
                std::vector<Vec2>& ring) {
  const auto previous = std::size_t((s + face.size - 1) % face.size);
  Vec2 up = polar(flat.length[previous], flat.angle[std::size_t(s)]);
  up.x() *= length / flat.length[std::size_t(s)];
  const Vec2 along(length, 0);
  const double sign = turned ? -1 : 1;
  if (face.quad()) ring.push_back(sign * (up + along));
  ring.push_back(sign * up);
  ring.push_back(sign * (up - along));
}

// Directions of a face's grid at its corner c (exact for a triangle, the bilinear map's tangents
// for a quad).
struct Corner {
  Vec3 along, up;  // to the next corner, to the previous one
};

Corner corner(const ControlMesh& mesh, const Face& face, int c) {
  const auto at = [&](int k) -> const Vec3& {
    return mesh.positions[std::size_t(face.vertex[std::size_t((k + face.size) % face.size)])];
  };
  return {at(c + 1) - at(c), at(c - 1) - at(c)};
}

// The same in the middle of side s: a quad's grid is that of its parallelogram.
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

double mean_radius(const Chart& chart) {
  double sum = 0;
  for (const Vec2& p : chart.ring) sum += p.norm();
  return sum / double(chart.ring.size());
}

}  // namespace

void blend(const Chart& uniform, double alpha, Chart& chart) {
  const double scale = mean_radius(chart) / mean_radius(uniform);
  double cosine = 0, sine = 0;
  for (std::size_t k = 0; k < chart.ring.size(); ++k) {
    const Vec2 &from = uniform.ring[k], &to = chart.ring[k];
    cosine += from.dot(to);
    sine += from.x() * to.y() - from.y() * to.x();
  }
  const double length = std::hypot(cosine, sine);
  Eigen::Matrix2d turn = Eigen::Matrix2d::Identity();
  if (length > 0) turn << cosine / length, -sine / length, sine / length, cosine / length;
  for (std::size_t k = 0; k < chart.ring.size(); ++k)
    chart.ring[k] = alpha * chart.ring[k] + (1 - alpha) * scale * (turn * uniform.ring[k]);
  chart.area = alpha * chart.area + (1 - alpha) * scale * scale * uniform.area;
}

ChartMaker::ChartMaker(const ControlMesh& mesh, const ChartOptions& options)
    : mesh_(mesh),
      options_(options),
      flat_(flatten(mesh, options.kind == ChartKind::tangent ? 1.0 : options.exponent)) {
  if (options.blend != 1.0) uniform_ = flatten(mesh, 0.0);
}

Chart ChartMaker::vertex(Index v) const {
  Chart chart =
      options_.kind == ChartKind::tangent ? tangent_vertex(v) : exponential_vertex(v, flat_);
  if (!uniform_.empty()) blend(exponential_vertex(v, uniform_), options_.blend, chart);
  return chart;
}

Chart ChartMaker::edge(Index e) const {
  Chart chart = options_.kind == ChartKind::tangent ? tangent_edge(e) : exponential_edge(e, flat_);
  if (!uniform_.empty()) blend(exponential_edge(e, uniform_), options_.blend, chart);
  return chart;
}

Chart ChartMaker::face(Index f) const {
  Chart chart = options_.kind == ChartKind::tangent ? tangent_face(f) : exponential_face(f, flat_);
  if (!uniform_.empty()) blend(exponential_face(f, uniform_), options_.blend, chart);
  return chart;
}

// The exponential map: faces unfolded around the point, their angles scaled to a full turn.

Chart ChartMaker::exponential_vertex(Index v, const std::vector<FlatFace>& flat) const {
  Chart chart;
  const auto ring = mesh_.ring(v);
  double total = 0;
  for (const Spoke& spoke : ring)
    if (spoke.face >= 0) total += flat[std::size_t(spoke.face)].angle[std::size_t(spoke.corner)];
  chart.closed = mesh_.interior(v);
  // An open ring keeps its angle unless it would overlap itself.
  const double scale = chart.closed || total > 0.95 * full_turn
                           ? (chart.closed ? 1.0 : 0.95) * full_turn / total
                           : 1.0;
  double angle = 0;
  for (const Spoke& spoke : ring) {
    chart.ring.push_back(polar(edge_length(mesh_, flat, spoke.edge), scale * angle));
    if (spoke.face < 0) break;
    const Face& face = mesh_.faces[std::size_t(spoke.face)];
    const FlatFace& shape = flat[std::size_t(spoke.face)];
    const auto c = std::size_t(spoke.corner);
    if (face.quad()) {
      const Vec2 far = Vec2(shape.length[c], 0) + polar(shape.length[(c + 3) % 4], shape.angle[c]);
      chart.ring.push_back(polar(far.norm(), scale * (angle + std::atan2(far.y(), far.x()))));
    }
    angle += shape.angle[c];
    chart.area += corner_share(face, shape);
  }
  return chart;
}

Chart ChartMaker::exponential_edge(Index e, const std::vector<FlatFace>& flat) const {
  Chart chart;
  const Edge& edge = mesh_.edges[std::size_t(e)];
  const double length = edge_length(mesh_, flat, e);
  chart.closed = !edge.boundary();
  for (int h = 0; h < 2; ++h) {
    chart.ring.push_back(Vec2(h == 0 ? length : -length, 0));
    if (edge.side[std::size_t(h)] < 0) continue;
    const Side& side = mesh_.sides[std::size_t(edge.side[std::size_t(h)])];
    const Face& face = mesh_.faces[std::size_t(side.face)];
    const FlatFace& shape = flat[std::size_t(side.face)];
    append_row(face, shape, side.local, length, h == 1, chart.ring);
    chart.area += (face.quad() ? 2 : 3) * corner_share(face, shape);
  }
  return chart;
}

Chart ChartMaker::exponential_face(Index f, const std::vector<FlatFace>& flat) const {
  Chart chart;
  const Face& face = mesh_.faces[std::size_t(f)];
  const FlatFace& shape = flat[std::size_t(f)];
  const Vec2 a(shape.length[0], 0),
      b = polar(shape.length[std::size_t(face.size - 1)], shape.angle[0]);
  if (face.quad()) {
    chart.ring = {a, a + b, b, b - a, -a, -a - b, -b, a - b};
    chart.area = shape.area;
  } else {
    chart.ring = {a, b, b - a, -a, -b, a - b};
    chart.area = 2 * shape.area;
  }
  return chart;
}

// Tangent-plane charts: the linearly refined control mesh seen along its normal.

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

// Inside a face the grid is flat already.
Chart ChartMaker::tangent_face(Index f) const { return exponential_face(f, flat_); }

}  // namespace fairing
