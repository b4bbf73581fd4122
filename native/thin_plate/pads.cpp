// SPDX-License-Identifier: GPL-3.0-or-later
#include "thin_plate/pads.h"

#include <algorithm>
#include <cmath>

#include "parallel/cancel.h"
#include "parallel/reductions.h"

namespace fairing {
namespace {

// Bounds of the eigenvalues of M over its diagonal, element by element [Wathen 1987]: triangles
// have 1/2 … 2, quads 1/4 … 9/4; hats narrower than the faces lie within.
constexpr double least_eigenvalue = 0.25, largest_eigenvalue = 2.25;
constexpr int mass_steps = 12;  // each halves the error

constexpr double least_share = 0.125;  // of the width asked for: narrower pads are points

}  // namespace

Pads::Pads(const ControlMesh& mesh, const ChartOptions& charts, const Unknowns& unknowns,
           double size, Workers& workers)
    : mesh_(mesh), workers_(workers), size_(size), rows_(unknowns) {
  const double exponent = charts.kind == ChartKind::tangent ? 1.0 : charts.exponent;
  for (const FlatFace& flat : flatten(mesh, exponent)) area_.push_back(flat.area);
  const auto vertices = std::size_t(mesh.vertex_count());
  width_.assign(vertices, 0.0);
  for (std::size_t v = 0; v < vertices; ++v) {
    if (unknowns.vertex[v] || !mesh.vertex_fit(Index(v)) ||
        mesh.vertex_part(Index(v)) != RegionPart::inside)
      continue;
    width_[v] = size;
    rows_.vertex[v] = 1;
    rows_.any_vertex = true;
    ++count_;
  }
  row_begin_.assign(vertices + 1, 0);
  for (std::size_t v = 0; v < vertices; ++v) {
    Index neighbours = 0;
    if (under(v))
      for (const Spoke& spoke : mesh.ring(Index(v)))
        neighbours += 1 + (spoke.face >= 0 && mesh.faces[std::size_t(spoke.face)].quad());
    row_begin_[v + 1] = row_begin_[v] + neighbours;
  }
  column_.resize(std::size_t(row_begin_.back()));
  value_.resize(column_.size());
  diagonal_.resize(vertices);
  total_.resize(vertices);
}

void Pads::narrow(std::size_t v, int halvings) {
  if (!under(v)) return;
  width_[v] = std::ldexp(width_[v], -halvings);
  grid_ = nullptr;
  if (width_[v] >= least_share * size_) return;
  width_[v] = 0;
  std::fill(value_.begin() + row_begin_[v], value_.begin() + row_begin_[v + 1], 0.0);
  rows_.vertex[v] = 0;
  rows_.any_vertex = --count_ > 0;
}

double Pads::hat(double lambda, std::size_t v) const {
  return width_[v] > 0 ? std::max(0.0, 1 - (1 - lambda) / width_[v]) : 0.0;
}

// visit(i, j, share, hats) for every point of the closed face: its share of the face's area on this
// level, and the hats of the corners there.
template <class Visit>
void Pads::visit_face(const Face& face, Visit&& visit) const {
  const int n = grid_->n();
  const double cell = area_[std::size_t(&face - mesh_.faces.data())] / (double(n) * n);
  double hats[4];
  for (int j = 0; j <= n; ++j) {
    stop_in_large_face(j);
    const int row = face.quad() ? n : n - j;
    for (int i = 0; i <= row; ++i) {
      int sides = 0;  // that the point lies on
      if (face.quad()) {
        const double u = double(i) / n, v = double(j) / n, along[4] = {1 - u, u, u, 1 - u},
                     up[4] = {1 - v, 1 - v, v, v};
        for (std::size_t c = 0; c < 4; ++c) {
          const auto corner = std::size_t(face.vertex[c]);
          hats[c] = hat(along[c], corner) * hat(up[c], corner);
        }
        sides = (i == 0) + (i == n) + (j == 0) + (j == n);
        visit(i, j, sides == 0 ? cell : sides == 1 ? cell / 2 : cell / 4, hats);
      } else {
        const double lambda[3] = {double(n - i - j) / n, double(i) / n, double(j) / n};
        for (std::size_t c = 0; c < 3; ++c) hats[c] = hat(lambda[c], std::size_t(face.vertex[c]));
        sides = (i == 0) + (j == 0) + (i + j == n);
        visit(i, j, sides == 0 ? 2 * cell : sides == 1 ? cell : cell / 3, hats);
      }
    }
  }
}

double Pads::area_of_edge_point(Index e) const {
  double area = 0;
  for (const Index s : mesh_.edges[std::size_t(e)].side) {
    if (s < 0) continue;
    const auto f = std::size_t(mesh_.sides[std::size_t(s)].face);
    area += mesh_.faces[f].quad() ? 0.5 * area_[f] : area_[f];
  }
  return area / (double(grid_->n()) * grid_->n());
}

void Pads::set_level(const GridLevel& grid) {
  if (grid_ == &grid) return;
  grid_ = &grid;
  struct Element {
    double mass[4][4] = {}, total[4] = {};
  };
  std::vector<Element> elements(mesh_.faces.size());
  workers_.for_parts(elements.size(), element_grain(grid.n()),
                     [&](std::size_t begin, std::size_t end) {
                       for (std::size_t f = begin; f < end; ++f) {
                         const Face& face = mesh_.faces[f];
                         Element& out = elements[f];
                         visit_face(face, [&](int, int, double share, const double* hats) {
                           for (int a = 0; a < face.size; ++a) {
                             out.total[a] += share * hats[a];
                             for (int b = 0; b < face.size; ++b)
                               out.mass[a][b] += share * hats[a] * hats[b];
                           }
                         });
                       }
                     });
  workers_.for_parts(width_.size(), 256, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) {
      diagonal_[v] = total_[v] = 0;
      if (!under(v)) continue;
      auto at = std::size_t(row_begin_[v]);
      for (const Spoke& spoke : mesh_.ring(Index(v))) {
        // The neighbour along the spoke shares the faces on both of its sides.
        const Edge& edge = mesh_.edges[std::size_t(spoke.edge)];
        const Index other = edge.vertex[spoke.outward ? 1 : 0];
        double shared = 0;
        for (const Index s : edge.side) {
          if (s < 0) continue;
          const Side& side = mesh_.sides[std::size_t(s)];
          const int next = (side.local + 1) % mesh_.faces[std::size_t(side.face)].size;
          shared += elements[std::size_t(side.face)].mass[int(side.local)][next];
        }
        column_[at] = other;
        value_[at++] = shared;
        if (spoke.face < 0) continue;
        const Face& face = mesh_.faces[std::size_t(spoke.face)];
        const Element& element = elements[std::size_t(spoke.face)];
        const auto c = std::size_t(spoke.corner);
        diagonal_[v] += element.mass[c][c];
        total_[v] += element.total[c];
        if (!face.quad()) continue;
        column_[at] = face.vertex[(c + 2) % 4];
        value_[at++] = element.mass[c][(c + 2) % 4];
      }
    }
  });
}

void Pads::add_loads(const Loads& loads, double* r) const {
  const GridLevel& grid = *grid_;
  const int n = grid.n();
  const auto add = [](double* to, double weight, const Vec3& load) {
    for (std::size_t a = 0; a < 3; ++a) to[a] += weight * load[Eigen::Index(a)];
  };
  for_each_index(workers_, width_.size(), [&](std::size_t v) {
    if (!under(v)) return;
    double share = 0;
    for (const Spoke& spoke : mesh_.ring(Index(v)))
      if (spoke.face >= 0)
        share += area_[std::size_t(spoke.face)] / mesh_.faces[std::size_t(spoke.face)].size;
    add(r + 3 * v, share / (double(n) * n), loads[v]);
  });
  workers_.for_parts(n > 1 ? mesh_.edges.size() : 0, element_grain(n) * std::size_t(n),
                     [&](std::size_t begin, std::size_t end) {
                       for (std::size_t e = begin; e < end; ++e) {
                         const auto a = std::size_t(mesh_.edges[e].vertex[0]),
                                    b = std::size_t(mesh_.edges[e].vertex[1]);
                         if (!under(a) && !under(b)) continue;
                         const double share = area_of_edge_point(Index(e));
                         double* to = r + 3 * std::size_t(grid.edge_base(Index(e)));
                         for (int k = 1; k < n; ++k, to += 3) {
                           const double lambda = double(k) / n;
                           add(to, share,
                               hat(1 - lambda, a) * loads[a] + hat(lambda, b) * loads[b]);
                         }
                       }
                     });
  workers_.for_parts(mesh_.faces.size(), element_grain(n), [&](std::size_t begin, std::size_t end) {
    for (std::size_t f = begin; f < end; ++f) {
      const Face& face = mesh_.faces[f];
      const auto size = std::size_t(face.size);
      const bool quad = face.quad();
      // The corners' hats along a row are a ramp each: slope and value of a corner's coordinate.
      double inverse[4];
      Vec3 load[4];
      std::size_t pads = 0;
      int corner[4];
      for (std::size_t c = 0; c < size; ++c) {
        const auto v = std::size_t(face.vertex[c]);
        if (!under(v)) continue;
        corner[pads] = int(c);
        inverse[pads] = 1 / width_[v];
        load[pads++] = loads[v];
      }
      if (pads == 0) continue;
      const double step = 1.0 / n, cell = (quad ? 1 : 2) * area_[f] * step * step;
      double* to = r + 3 * std::size_t(grid.face_base(Index(f)));
      for (int j = 1; j < n; ++j) {
        stop_in_large_face(j);
        const int last = quad ? n : n - j;
        for (std::size_t p = 0; p < pads; ++p) {
          const int c = corner[p];
          double row_factor = cell, at, slope;  // the coordinate at i = 0, and its change
          if (quad) {
            row_factor *= std::max(0.0, 1 - (1 - (c < 2 ? 1 - j * step : j * step)) * inverse[p]);
            at = c == 0 || c == 3 ? 1 : 0;
            slope = c == 0 || c == 3 ? -step : step;
          } else {
            at = c == 0 ? 1 - j * step : c == 1 ? 0 : j * step;
            slope = c == 0 ? -step : c == 1 ? step : 0;
          }
          if (row_factor == 0) continue;
          for (int i = 1; i < last; ++i) {
            const double h = row_factor * std::max(0.0, 1 - (1 - (at + slope * i)) * inverse[p]);
            double* const point = to + 3 * (i - 1);
            point[0] += h * load[p][0];
            point[1] += h * load[p][1];
            point[2] += h * load[p][2];
          }
        }
        to += 3 * std::max(0, last - 1);
      }
    }
  });
}

void Pads::multiply_mass(const Loads& loads, Loads& forces) const {
  forces.resize(loads.size());
  workers_.for_parts(loads.size(), 1024, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) {
      forces[v] = diagonal_[v] * loads[v];
      for (auto k = std::size_t(row_begin_[v]); k < std::size_t(row_begin_[v + 1]); ++k)
        forces[v] += value_[k] * loads[std::size_t(column_[k])];
    }
  });
}

// Chebyshev's semi-iteration on the diagonally scaled matrix.
void Pads::divide_by_mass(const Loads& forces, Loads& loads) const {
  constexpr double middle = 0.5 * (largest_eigenvalue + least_eigenvalue),
                   half = 0.5 * (largest_eigenvalue - least_eigenvalue), shape = middle / half;
  Loads step(forces.size(), Vec3::Zero()), product;
  loads.assign(forces.size(), Vec3::Zero());
  double rho = 1 / shape;
  for (int k = 0; k < mass_steps; ++k) {
    multiply_mass(loads, product);
    const double next = 1 / (2 * shape - rho), carry = k == 0 ? 0 : rho * next,
                 gain = k == 0 ? 1 / middle : 2 * next / half;
    for (std::size_t v = 0; v < forces.size(); ++v) {
      if (!under(v)) continue;
      step[v] = carry * step[v] + gain / diagonal_[v] * (forces[v] - product[v]);
      loads[v] += step[v];
    }
    if (k > 0) rho = next;
  }
}

}  // namespace fairing
