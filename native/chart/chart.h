// SPDX-License-Identifier: GPL-3.0-or-later
// Charts: plane coordinates for the one-ring of every kind of lattice point, at unit lattice spacing (level l shrinks
// them by 2^l). In the control metric one chart serves all interior points of a control face, one all points of a
// control edge, and each control vertex has its own.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "chart/metric.h"
#include "control_mesh/control_mesh.h"

namespace fairing {

using Vec2 = Eigen::Vector2d;

enum class ChartKind {
  exponential,  // edge lengths as radii, corner angles summed and scaled to 2 pi
  tangent,      // orthogonal projection to the tangent plane of the control mesh
};

struct ChartOptions {
  ChartKind kind = ChartKind::exponential;
  double exponent = 0.5;  // of the metric; the tangent plane knows no other than 1
  double blend = 1.0;     // 0: uniform chart … 1: the chart itself [Kobbelt 1997b]
};

// The neighbours of a point, counter-clockwise.
struct Chart {
  std::vector<Vec2> ring;
  double area = 0;     // the point's share of the metric's area at unit spacing: the weight of its energy
  bool closed = true;  // the ring goes all round
};

// Makes the charts of one control mesh. All options are checked by the caller.
class ChartMaker {
 public:
  ChartMaker(const ControlMesh& mesh, const ChartOptions& options);

  // A control vertex: for each spoke the point along it, then, behind it, the far corner of a quad.
  Chart vertex(Index v) const;
  // A point inside an edge: forward along the edge; the left face's row from front to back (a triangle has two
  // points there, a quad three); backward; the right face's row likewise, from back to front.
  Chart edge(Index e) const;
  // A point inside a face: a, b, c, -a, -b, -c with a along i, b along j, c = b - a (triangle);
  // s, s + t, t, t - s and their opposites (quad).
  Chart face(Index f) const;

  const std::vector<FlatFace>& flat() const { return flat_; }

 private:
  Chart exponential_vertex(Index v, const std::vector<FlatFace>& flat) const;
  Chart exponential_edge(Index e, const std::vector<FlatFace>& flat) const;
  Chart exponential_face(Index f, const std::vector<FlatFace>& flat) const;
  Chart tangent_vertex(Index v) const;
  Chart tangent_edge(Index e) const;
  Chart tangent_face(Index f) const;

  const ControlMesh& mesh_;
  ChartOptions options_;
  std::vector<FlatFace> flat_;     // in the chosen metric
  std::vector<FlatFace> uniform_;  // exponent 0, for the blend
};

}  // namespace fairing
