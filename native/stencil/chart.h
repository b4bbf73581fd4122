// SPDX-License-Identifier: GPL-3.0-or-later
// Charts: plane coordinates of the one-ring of every kind of grid point, at unit grid spacing
// (level l shrinks them by 2^l). In the control metric one chart serves all interior points of a
// control face, one all points of a control edge, and each control vertex has its own.
//
// They unfold the faces around the point and scale the angles to a full turn (the discrete
// exponential map). The paper's own charts are in paper/charts.h.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "mesh/control_mesh.h"
#include "stencil/metric.h"

namespace fairing {

// The default exponent of the metric, between uniform charts (0) and true lengths (1).
constexpr double centripetal = 0.5;

// The neighbours of a point, counter-clockwise.
struct Chart {
  std::vector<Vec2> ring;
  // The point's share of the metric's area at unit spacing: the weight of its energy.
  double area = 0;
  bool closed = true;  // the ring is closed
};

double mean_radius(const Chart& chart);

// The factor for angles with the sum `total` around a point: a closed ring becomes a full turn; an
// open one keeps its angle unless it would overlap itself.
double turn_scale(bool closed, double total);

// Makes the charts of one control mesh, which must outlive it. Coordinates are lengths of the
// metric, in (mesh units)^b for the exponent b from 0 to 1.
class ChartMaker {
 public:
  explicit ChartMaker(const ControlMesh& mesh, double exponent = centripetal)
      : mesh_(mesh), flat_(flatten(mesh, exponent)) {}
  virtual ~ChartMaker() = default;

  // The faces in the metric.
  const std::vector<FlatFace>& flat() const { return flat_; }

  // A control vertex: for each spoke the point along it, followed by the far corner of the quad
  // behind it.
  virtual Chart vertex(Index v) const;
  // A point inside an edge: forward along the edge; the left face's row from front to back (two
  // points in a triangle, three in a quad); backward; the right face's row likewise, from back to
  // front.
  virtual Chart edge(Index e) const;
  // A point inside a face: a, b, c, -a, -b, -c with a along i, b along j, c = b - a (triangle);
  // s, s + t, t, t - s and their opposites (quad). The order of face_ring() (grid/ring.h).
  virtual Chart face(Index f) const;

 protected:
  const ControlMesh& mesh() const { return mesh_; }

 private:
  const ControlMesh& mesh_;
  std::vector<FlatFace> flat_;
};

}  // namespace fairing
