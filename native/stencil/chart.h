// SPDX-License-Identifier: GPL-3.0-or-later
// Charts: plane coordinates for the one-ring of every kind of grid point, at unit grid spacing
// (level l shrinks them by 2^l). In the control metric one chart serves all interior points of a
// control face, one all points of a control edge, and each control vertex has its own.
//
// Exponential charts unfold the faces around the point, with their angles scaled to a full turn
// (the discrete exponential map). Tangent charts see the linearly refined control mesh along its
// normal.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "mesh/control_mesh.h"
#include "stencil/metric.h"

namespace fairing {

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
  // The point's share of the metric's area at unit spacing: the weight of its energy.
  double area = 0;
  bool closed = true;  // the ring goes all round
};

// chart <- (1 - alpha) uniform + alpha chart [Kobbelt 1997b], after the uniform chart has been
// brought to the chart's mean radius and turned by the rotation that fits best: so the blend
// depends on no choice of a first neighbour.
void blend(const Chart& uniform, double alpha, Chart& chart);

// Makes the charts of one control mesh, which must outlive it. All options are checked by the
// caller. Coordinates are lengths of the metric, of exponent b: (mesh units)^b.
class ChartMaker {
 public:
  ChartMaker(const ControlMesh& mesh, const ChartOptions& options);

  // A control vertex: for each spoke the point along it, then, behind it, the far corner of a quad.
  Chart vertex(Index v) const;
  // A point inside an edge: forward along the edge; the left face's row from front to back (a
  // triangle has two points there, a quad three); backward; the right face's row likewise, from
  // back to front.
  Chart edge(Index e) const;
  // A point inside a face: a, b, c, -a, -b, -c with a along i, b along j, c = b - a (triangle);
  // s, s + t, t, t - s and their opposites (quad). The order of face_ring() (grid/ring.h).
  Chart face(Index f) const;

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
