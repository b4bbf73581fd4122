// SPDX-License-Identifier: GPL-3.0-or-later
#include "stencil/chart.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "stencil/angle.h"

namespace fairing {
namespace {

// Share of a full turn: the angle of an open ring that would otherwise overlap itself.
constexpr double widest_open = 0.95;

Vec2 polar(double radius, double angle) {
  return {radius * std::cos(angle), radius * std::sin(angle)};
}

// The point's share of the face's area at unit spacing, for one corner of one cell.
double corner_share(const Face& face, const FlatFace& flat) { return flat.area / face.size; }

bool is_flat(const ControlMesh& mesh, const Spoke& spoke) {
  return spoke.face >= 0 && !mesh.flat.face.empty() && mesh.flat.face[spoke.face];
}

// The factors for the angles around a vertex, of faces that are [0] not flat, [1] flat. Where the
// two are divided by a line that turns by at most 60 degrees, each side becomes a half turn, as
// beside a smooth curve; elsewhere both have turn_scale().
std::array<double, 2> turn_scales(const ControlMesh& mesh, const std::vector<FlatFace>& flat,
                                  Index v) {
  const auto ring = mesh.ring(v);
  std::array<double, 2> total{};
  int changes = 0;
  bool before = is_flat(mesh, ring.back());
  for (const Spoke& spoke : ring) {
    const bool now = is_flat(mesh, spoke);
    changes += now != before;
    before = now;
    if (spoke.face >= 0) total[now] += flat[spoke.face].angle[spoke.corner];
  }
  const double half = full_turn / 2;
  const bool smooth =
      std::ranges::all_of(total, [&](double angle) { return std::abs(angle - half) <= half / 3; });
  if (mesh.interior(v) && changes == 2 && smooth) return {half / total[0], half / total[1]};
  const double scale = turn_scale(mesh.interior(v), total[0] + total[1]);
  return {scale, scale};
}

// Appends the row of the face on one side of an edge point, front to back, in a frame whose x axis
// is the side. The face is scaled along the edge until its side has the edge's length: with
// different spacings of the two rows and the edge, every function with a slope along the edge would
// have a twist, which grows as the grid is refined.
void append_row(const Face& face, const FlatFace& flat, int s, double length, bool turned,
                std::vector<Vec2>& ring) {
  const auto previous = std::size_t((s + face.size - 1) % face.size);
  Vec2 up = polar(flat.length[previous], flat.angle[s]);
  up.x() *= length / flat.length[s];
  const Vec2 along(length, 0);
  const double sign = turned ? -1 : 1;
  if (face.quad()) ring.push_back(sign * (up + along));
  ring.push_back(sign * up);
  ring.push_back(sign * (up - along));
}

}  // namespace

double mean_radius(const Chart& chart) {
  double sum = 0;
  for (const Vec2& p : chart.ring) sum += p.norm();
  return sum / double(chart.ring.size());
}

double turn_scale(bool closed, double total) {
  const double most = (closed ? 1.0 : widest_open) * full_turn;
  return closed || total > most ? most / total : 1.0;
}

Chart ChartMaker::vertex(Index v) const {
  Chart chart;
  const auto ring = mesh_.ring(v);
  chart.closed = mesh_.interior(v);
  const std::array<double, 2> scales = turn_scales(mesh_, flat_, v);
  double angle = 0;
  for (const Spoke& spoke : ring) {
    chart.ring.push_back(polar(edge_length(mesh_, flat_, spoke.edge), angle));
    if (spoke.face < 0) break;
    const Face& face = mesh_.faces[spoke.face];
    const FlatFace& shape = flat_[spoke.face];
    const auto c = std::size_t(spoke.corner);
    const double scale = scales[is_flat(mesh_, spoke)];
    if (face.quad()) {
      const Vec2 far = Vec2(shape.length[c], 0) + polar(shape.length[(c + 3) % 4], shape.angle[c]);
      chart.ring.push_back(polar(far.norm(), angle + scale * std::atan2(far.y(), far.x())));
    }
    angle += scale * shape.angle[c];
    chart.area += corner_share(face, shape);
  }
  return chart;
}

Chart ChartMaker::edge(Index e) const {
  Chart chart;
  const Edge& edge = mesh_.edges[e];
  const double length = edge_length(mesh_, flat_, e);
  chart.closed = !edge.boundary();
  for (int h = 0; h < 2; ++h) {
    chart.ring.push_back(Vec2(h == 0 ? length : -length, 0));
    if (edge.side[h] < 0) continue;
    const Side& side = mesh_.sides[edge.side[h]];
    const Face& face = mesh_.faces[side.face];
    const FlatFace& shape = flat_[side.face];
    append_row(face, shape, side.local, length, h == 1, chart.ring);
    chart.area += (face.quad() ? 2 : 3) * corner_share(face, shape);
  }
  return chart;
}

Chart ChartMaker::face(Index f) const {
  Chart chart;
  const Face& face = mesh_.faces[f];
  const FlatFace& shape = flat_[f];
  const Vec2 a(shape.length[0], 0), b = polar(shape.length[face.size - 1], shape.angle[0]);
  if (face.quad()) {
    chart.ring = {a, a + b, b, b - a, -a, -a - b, -b, a - b};
    chart.area = shape.area;
  } else {
    chart.ring = {a, b, b - a, -a, -b, a - b};
    chart.area = 2 * shape.area;
  }
  return chart;
}

}  // namespace fairing
