// SPDX-License-Identifier: GPL-3.0-or-later
// Pads: they replace point forces at control vertices. The force at a control vertex c is spread
// over the faces around it as a load f_c on a hat phi_c, so that a surface x with the energy x . K
// x / 2 satisfies
//
//   K x = Omega sum_c f_c phi_c,   x(p_c) = v_c   for every held control vertex c,            (*)
//
// with Omega the weights of a level's points. A point force makes a surface r^2 log r and its
// curvature a logarithm: a spot at every control vertex. A load is as smooth as its hat. (In one
// dimension, with hats as wide as the intervals, (*) is the interpolating quintic spline.)
//
// With s_ca the share of a control edge over which the pad of c reaches (pad_reach.h), the hat is,
// in a triangle with corners c, a, b and in a quad c, a, d, b,
//
//   phi_c = max(0, 1 - lambda_a / s_ca - lambda_b / s_cb),
//   phi_c = max(0, 1 - xi / s_ca) max(0, 1 - eta / s_cb),
//
// with lambda barycentric and (xi, eta) the quad's own coordinates. s -> 0 is the point force.
#pragma once

#include <algorithm>
#include <array>
#include <vector>

#include "grid/accumulate.h"
#include "stencil/chart.h"
#include "stencil/weights.h"

namespace fairing {

// A load, or a force, for each control vertex, of N numbers: 3 for the thin plate, 1 along normals.
// Zero without a pad.
template <int N>
using LoadsOf = std::vector<Eigen::Matrix<double, N, 1>>;
using Loads = LoadsOf<3>;
using NormalLoads = LoadsOf<1>;

// Off all curves and inside the region.
inline bool may_have_pad(const ControlMesh& mesh, Index v) {
  return mesh.vertex_fit(v) && mesh.vertex_part(v) == RegionPart::inside;
}

// Which control vertices have pads, and how far these reach.
class Pads {
 public:
  // `size` in (0, 1] multiplies all reaches. Every control vertex off curves, inside the region,
  // that is fixed or has a weight gets a pad. Positions of `mesh` are in working coordinates.
  Pads(const ControlMesh& mesh, const ChartMaker& charts, const Unknowns& unknowns, double size,
       Workers& workers, const VertexWeights& weights = {});

  // Whether any control vertex has a pad.
  bool any() const { return any_; }
  bool under(std::size_t v) const { return under_[v] != 0; }
  // Largest reach of a pad along the edges around it; 0 without a pad.
  double reach(std::size_t v) const;
  // The unknowns and the control vertices on pads: the rows of K in (*).
  const Unknowns& rows() const { return rows_; }

 private:
  friend class Hats;

  double inverse_reach(const Spoke& spoke) const {
    return inverse_[spoke.edge][spoke.outward ? 0 : 1];
  }

  const ControlMesh* mesh_;
  Workers* workers_;
  std::vector<double> area_;  // per control face, in the control metric
  std::vector<std::uint8_t> under_;
  std::vector<std::array<double, 2>> inverse_;  // 1 / s_ca at both ends of each edge
  bool any_ = false;
  Unknowns rows_;
};

// The pads' hats, sampled on a level's points.
class Hats {
 public:
  // `omega`: one number a point; empty: the points' shares of the control metric's area, times
  // 4^-level. Pads and grid must outlive the hats.
  Hats(const Pads& pads, const GridLevel& grid, Array<double> omega = {});

  const GridLevel& grid() const { return grid_; }
  const Unknowns& rows() const { return pads_.rows(); }
  bool under(std::size_t v) const { return pads_.under(v); }

  // r <- r + Omega sum_c f_c phi_c on all points of the level, control vertices included.
  void add_loads(const Loads& loads, double* r) const;
  void add_loads(const NormalLoads& loads, double* r) const;
  // sum_i phi_c(i) r_i for every control vertex c on a pad; r: one number a point.
  NormalLoads gather(const Array<double>& r) const;

  // The following functions use M_cd = sum_i Omega_i phi_c(i) phi_d(i), the hats' mass matrix.
  template <int N>
  void multiply_mass(const LoadsOf<N>& loads, LoadsOf<N>& forces) const;
  // loads <- (M + R T)^-1 (1 + R) forces, by a fixed number of Chebyshev steps: a linear map, to
  // 1e-3 or better. R is diagonal: `compliance_ratio`, one number a control vertex; empty: zero. T
  // has the total of each hat.
  template <int N>
  void divide_by_mass(const LoadsOf<N>& forces, LoadsOf<N>& loads,
                      const std::vector<double>& compliance_ratio = {}) const;
  // The total of a hat, sum_i Omega_i phi_c(i): the force of a unit load.
  double total(std::size_t v) const { return total_[v]; }

 private:
  // Sums of the hats on a control face or edge, and of their products.
  struct Element {
    double mass[4][4] = {}, total[4] = {};

    void add(double weight, const double* hats, int count);
  };
  // The hat of a corner along one row of a face's points, at point (i, j).
  struct RowHat {
    double factor, at, slope;

    double operator()(int i) const { return factor * std::max(0.0, at + slope * i); }
  };
  RowHat row_hat(const Face& face, std::size_t corner, int j) const;
  // The hat of the pad of end `h` of an edge, a share `t` of the edge away from it.
  double hat(std::size_t e, std::size_t h, double t) const {
    return under(std::size_t(mesh_.edges[e].vertex[h]))
               ? std::max(0.0, 1 - t * pads_.inverse_[e][h])
               : 0.0;
  }
  // 1 / s_ca along the side from `corner` to the next, seen from its first or its second corner.
  double inverse_along(const Face& face, std::size_t side, bool from_second) const;

  // Weights of points: `weight` if given, otherwise those of the metric.
  double vertex_weight(std::size_t v, const double* weight) const;
  double metric_weight_of_edge_point(std::size_t e) const;
  double metric_weight_of_face_point(std::size_t f) const;
  std::vector<Element> elements_of_faces(const double* weight) const;
  std::vector<Element> elements_of_edges(const double* weight) const;
  const double* weights() const { return weight_.empty() ? nullptr : weight_.data(); }

  template <int N>
  void add_any(const LoadsOf<N>& loads, double* r) const;

  const Pads& pads_;
  const GridLevel& grid_;
  const ControlMesh& mesh_;
  Workers& workers_;
  const Array<double> weight_;  // per point of the level; empty: those of the metric

  // M on the control mesh: rows of the vertices on pads, without the diagonal.
  std::vector<Index> row_begin_, column_;
  std::vector<double> value_, diagonal_, total_;
};

}  // namespace fairing
