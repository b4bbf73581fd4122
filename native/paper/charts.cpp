// SPDX-License-Identifier: GPL-3.0-or-later
#include "paper/charts.h"

#include <Eigen/Geometry>
#include <cmath>

#include "base/roundoff.h"
#include "mesh/normal.h"

namespace fairing {
namespace {

// Directions of a face's grid at its corner c; for a quad the tangents of the bilinear map.
struct Corner {
  Vec3 along, up;  // to the next corner, to the previous one
};

Corner corner(const ControlMesh& mesh, const Face& face, int c) {
  const auto at = [&](int k) -> const Vec3& {
    return mesh.positions[face.vertex[(k + face.size) % face.size]];
  };
  return {at(c + 1) - at(c), at(c - 1) - at(c)};
}

// The same at the middle of side s; the grid of a quad is that of its parallelogram.
Corner middle(const ControlMesh& mesh, const Face& face, int s) {
  if (!face.quad()) return corner(mesh, face, s);
  const Corner here = corner(mesh, face, s), there = corner(mesh, face, (s + 2) % 4);
  return {0.5 * (here.along - there.along), 0.5 * (here.up - there.up)};
}

struct Frame {
  Vec3 x, y;
  explicit Frame(const Vec3& normal)
      : x(normal.unitOrthogonal()), y(normal.normalized().cross(x)) {}
  Vec2 project(const Vec3& p) const { return {p.dot(x), p.dot(y)}; }
};

// to <- (1 - alpha) scale from + alpha to
void blend(const Array<double>& from, double alpha, double scale, Array<double>& to) {
  for (std::size_t i = 0; i < to.size(); ++i) to[i] = alpha * to[i] + (1 - alpha) * scale * from[i];
}

}  // namespace

Chart TangentCharts::vertex(Index v) const {
  const auto ring = mesh().ring(v);
  const Vec3 normal = control_normal(mesh(), v);
  Chart chart = ChartMaker::vertex(v);
  if (normal.norm() == 0) return chart;  // no tangent plane there
  const Frame frame(normal);
  chart.ring.clear();
  for (const Spoke& spoke : ring) {
    chart.ring.push_back(
        frame.project(mesh().positions[mesh().end_of(spoke)] - mesh().positions[v]));
    if (spoke.face < 0) break;
    const Face& face = mesh().faces[spoke.face];
    if (face.quad()) {
      const Corner c = corner(mesh(), face, spoke.corner);
      chart.ring.push_back(frame.project(c.along + c.up));
    }
  }
  return chart;
}

Chart TangentCharts::edge(Index e) const {
  const Edge& edge = mesh().edges[e];
  Vec3 normal = Vec3::Zero();
  for (const Index s : edge.side)
    if (s >= 0) {
      const Side& side = mesh().sides[s];
      const Corner m = middle(mesh(), mesh().faces[side.face], side.local);
      normal += m.along.cross(m.up).normalized();
    }
  Chart chart = ChartMaker::edge(e);
  if (!(normal.norm() > single_roundoff)) return chart;
  const Frame frame(normal);
  const Vec2 forward =
      frame.project(mesh().positions[edge.vertex[1]] - mesh().positions[edge.vertex[0]]);
  chart.ring.clear();
  for (int h = 0; h < 2; ++h) {
    chart.ring.push_back(h == 0 ? forward : Vec2(-forward));
    if (edge.side[h] < 0) continue;
    const Side& side = mesh().sides[edge.side[h]];
    const Face& face = mesh().faces[side.face];
    const Vec2 up = frame.project(middle(mesh(), face, side.local).up),
               along = h == 0 ? forward : Vec2(-forward);
    if (face.quad()) chart.ring.push_back(up + along);
    chart.ring.push_back(up);
    chart.ring.push_back(up - along);
  }
  return chart;
}

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

std::unique_ptr<ChartMaker> make_charts(const ControlMesh& mesh, double exponent,
                                        const PaperOptions& options) {
  const bool tangent = options.chart == ChartKind::tangent;
  if (options.chart_blend == 1)
    return tangent ? std::make_unique<TangentCharts>(mesh)
                   : std::make_unique<ChartMaker>(mesh, exponent);
  if (tangent) return std::make_unique<BlendedCharts<TangentCharts>>(options.chart_blend, mesh);
  return std::make_unique<BlendedCharts<ChartMaker>>(options.chart_blend, mesh, exponent);
}

Stencils make_stencils(const ControlMesh& mesh, const ChartMaker& charts,
                       const PaperOptions& options, Workers& workers,
                       const MembraneOptions& membrane) {
  Stencils out = make_stencils(mesh, charts, workers, membrane);
  const double alpha = options.chart_blend;
  if (out.tension.empty() || alpha == 1) return out;
  const ChartMaker uniform(mesh, 0);
  const Array<double> other = make_membrane(mesh, uniform, out.begin, membrane);
  // Keeps the mean radius of the charts.
  const double ratio = mean_edge(mesh, uniform.flat()) / mean_edge(mesh, charts.flat()),
               scale = ratio * ratio;
  blend(other, alpha, scale, out.tension);
  return out;
}

}  // namespace fairing
