// SPDX-License-Identifier: GPL-3.0-or-later
// Pads: what holds control vertices in place of point forces. The force at a control vertex c is
// spread over the faces around it as a load f_c on a hat phi_c, so that a surface x with the energy
// x . K x / 2 is
//
//   K x = Omega sum_c f_c phi_c,   x(p_c) = v_c   for every held control vertex c,            (*)
//
// with Omega the weights of a level's points. A point force makes a surface r^2 log r and its
// curvature a logarithm: a spot at every control vertex. A load is as smooth as its hat. (In one
// dimension, with hats as wide as the intervals, (*) is the interpolating quintic spline.) The hat
// of width s is, with lambda the barycentric coordinate of c in a control triangle,
//
//   phi_c = max(0, 1 - (1 - lambda) / s),
//
// and in a quad the product of two such in its own coordinates. s -> 0 is the point force.
#pragma once

#include <algorithm>
#include <vector>

#include "grid/accumulate.h"
#include "stencil/chart.h"
#include "stencil/weights.h"

namespace fairing {

// A load, or a force, for each control vertex, of N numbers: 3 for the thin plate, 1 along normals.
// Zero where there is no pad.
template <int N>
using LoadsOf = std::vector<Eigen::Matrix<double, N, 1>>;
using Loads = LoadsOf<3>;
using NormalLoads = LoadsOf<1>;

class Pads {
 public:
  // `size` in (0, 1] is the width of all pads, until one is narrowed. A pad is under every control
  // vertex that is fixed or has a weight, off all curves and inside the region. Positions of `mesh`
  // in working coordinates.
  Pads(const ControlMesh& mesh, const ChartOptions& charts, const Unknowns& unknowns, double size,
       Workers& workers, const VertexWeights& weights = {});

  // False where no control vertex stands on a pad.
  bool any() const { return count_ > 0; }
  bool under(std::size_t v) const { return width_[v] > 0; }
  // The same before any pad was narrowed.
  bool began_under(std::size_t v) const { return row_begin_[v + 1] > row_begin_[v]; }
  bool is_whole(std::size_t v) const { return width_[v] == size_; }
  // Of each control vertex; 0 where it stands on none.
  const std::vector<double>& widths() const { return width_; }
  // Halves a width so many times; below an eighth of `size` the pad is gone, and the vertex held by
  // a point force. Call set_level() before what follows it.
  void narrow(std::size_t v, int halvings);
  // The unknowns and the control vertices on pads: the rows of K that (*) speaks of.
  const Unknowns& rows() const { return rows_; }

  // Hats are sampled on a level's points. Omega are the points' shares of the control metric's
  // area, 4^-level of them. Call before what follows when the level changes.
  void set_level(const GridLevel& grid);
  // The same with other weights Omega, one a point.
  void set_level(const GridLevel& grid, Array<double> weights);

  // r <- r + Omega sum_c f_c phi_c on all points of the level, control vertices included.
  void add_loads(const Loads& loads, double* r) const;
  void add_loads(const NormalLoads& loads, double* r) const;
  // sum_i phi_c(i) r_i for every control vertex c on a pad; r: one number a point.
  NormalLoads gather(const Array<double>& r) const;

  // What follows is about M_cd = sum_i Omega_i phi_c(i) phi_d(i), the hats' mass matrix.
  template <int N>
  void multiply_mass(const LoadsOf<N>& loads, LoadsOf<N>& forces) const;
  // loads <- (M + R T)^-1 (1 + R) forces, by a fixed number of Chebyshev steps: a linear map, to
  // 1e-3 or better. R is a diagonal matrix, `give`, one number a control vertex; empty: zero. T has
  // the total of each hat.
  template <int N>
  void divide_by_mass(const LoadsOf<N>& forces, LoadsOf<N>& loads,
                      const std::vector<double>& give = {}) const;
  // The whole of a hat, sum_i Omega_i phi_c(i): the force of a unit load.
  double total(std::size_t v) const { return total_[v]; }

 private:
  // Of the hats, on a control face or an edge: the sums of their products and of themselves.
  struct Element {
    double mass[4][4] = {}, total[4] = {};

    void add(double weight, const double* hats, int count);
  };
  // The hat of a corner along one row of a face's points, at point (i, j).
  struct RowHat {
    double factor, at, slope, inverse;

    double operator()(int i) const {
      return factor * std::max(0.0, 1 - (1 - (at + slope * i)) * inverse);
    }
  };
  RowHat row_hat(const Face& face, std::size_t corner, int j) const;
  double hat(double lambda, std::size_t v) const;

  // Weights of points: `weight` where there are such, otherwise by the metric.
  double vertex_weight(std::size_t v, const double* weight) const;
  double metric_weight_of_edge_point(std::size_t e) const;
  double metric_weight_of_face_point(std::size_t f) const;
  std::vector<Element> elements_of_faces(const double* weight) const;
  std::vector<Element> elements_of_edges(const double* weight) const;
  const double* weights() const { return weight_.empty() ? nullptr : weight_.data(); }

  void fill_matrix();
  template <int N>
  void add_any(const LoadsOf<N>& loads, double* r) const;

  const ControlMesh* mesh_;
  Workers* workers_;
  double size_;
  const GridLevel* grid_ = nullptr;
  std::vector<double> area_;   // of each control face, in the control metric
  std::vector<double> width_;  // of each control vertex' pad; 0: none
  std::size_t count_ = 0;
  Unknowns unknowns_, rows_;
  Array<double> weight_;  // of the level's points; empty: those of the metric

  // M on the control mesh: rows of the vertices on pads, the diagonal apart.
  std::vector<Index> row_begin_, column_;
  std::vector<double> value_, diagonal_, total_;
};

}  // namespace fairing
