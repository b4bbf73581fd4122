// SPDX-License-Identifier: GPL-3.0-or-later
// Pads: what holds control vertices in place of point forces. The force at a control vertex c is
// spread over the faces around it as a load f_c on a hat phi_c, so that the plate is
//
//   K x = Omega sum_c f_c phi_c,   x(p_c) = v_c   for every held control vertex c,            (*)
//
// with Omega the points' shares of the control metric's area, 4^-level of them on a level. A point
// force makes a surface r^2 log r and its curvature a logarithm: a spot at every control vertex. A
// load is as smooth as its hat. (In one dimension, with hats as wide as the intervals, (*) is the
// interpolating quintic spline.) The hat of width s is, with lambda the barycentric coordinate of
// c in a control triangle,
//
//   phi_c = max(0, 1 - (1 - lambda) / s),
//
// and in a quad the product of two such in its own coordinates. s -> 0 is the point force.
#pragma once

#include <vector>

#include "grid/accumulate.h"
#include "stencil/chart.h"

namespace fairing {

// A load, or a force, for each control vertex; zero where there is no pad.
using Loads = std::vector<Vec3>;

class Pads {
 public:
  // `size` in (0, 1] is the width of all pads, until one is narrowed. A pad is under every control
  // vertex that is fixed, off all curves and inside the region. Positions of `mesh` in working
  // coordinates.
  Pads(const ControlMesh& mesh, const ChartOptions& charts, const Unknowns& unknowns, double size,
       Workers& workers);

  // False where no control vertex stands on a pad.
  bool any() const { return count_ > 0; }
  bool under(std::size_t v) const { return width_[v] > 0; }
  // The same before any pad was narrowed.
  bool began_under(std::size_t v) const { return row_begin_[v + 1] > row_begin_[v]; }
  // Of each control vertex; 0 where it stands on none.
  const std::vector<double>& widths() const { return width_; }
  // Halves a width so many times; below an eighth of `size` the pad is gone, and the vertex held by
  // a point force. Call set_level() before what follows it.
  void narrow(std::size_t v, int halvings);
  // The unknowns and the control vertices on pads: the rows of K that (*) speaks of.
  const Unknowns& rows() const { return rows_; }

  // Hats are sampled on a level's points. Call before what follows when the level changes.
  void set_level(const GridLevel& grid);

  // r <- r + Omega sum_c f_c phi_c on all points of the level, control vertices included.
  void add_loads(const Loads& loads, double* r) const;

  // What follows is about M_cd = sum_i Omega_i phi_c(i) phi_d(i), the hats' mass matrix.
  void multiply_mass(const Loads& loads, Loads& forces) const;
  // loads <- M^-1 forces, by a fixed number of Chebyshev steps: a linear map, to 1e-3 or better.
  void divide_by_mass(const Loads& forces, Loads& loads) const;
  // The whole of a hat, sum_i Omega_i phi_c(i): the force of a unit load.
  double total(std::size_t v) const { return total_[v]; }

 private:
  template <class Visit>
  void visit_face(const Face& face, Visit&& visit) const;
  double area_of_edge_point(Index e) const;
  double hat(double lambda, std::size_t v) const;

  const ControlMesh& mesh_;
  Workers& workers_;
  double size_;
  const GridLevel* grid_ = nullptr;
  std::vector<double> area_;   // of each control face, in the control metric
  std::vector<double> width_;  // of each control vertex' pad; 0: none
  std::size_t count_ = 0;
  Unknowns rows_;

  // M on the control mesh: rows of the vertices on pads, the diagonal apart.
  std::vector<Index> row_begin_, column_;
  std::vector<double> value_, diagonal_, total_;
};

}  // namespace fairing
