// SPDX-License-Identifier: GPL-3.0-or-later
#include "constraints/pads.h"

#include <algorithm>
#include <cmath>

#include "base/roundoff.h"
#include "constraints/pad_reach.h"
#include "parallel/cancel.h"
#include "parallel/reductions.h"

namespace fairing {
namespace {

// Bounds of the eigenvalues of M over its diagonal, element by element [Wathen 1987]: triangles
// have 1/2 … 2, quads 1/4 … 9/4; hats narrower than the faces are within these.
constexpr double least_mass_eigenvalue = 0.25, largest_mass_eigenvalue = 2.25;
constexpr int mass_steps = 12;  // each halves the error

}  // namespace

Pads::Pads(const ControlMesh& mesh, const ChartMaker& charts, const Unknowns& unknowns, double size,
           Workers& workers, const VertexWeights& weights)
    : mesh_(&mesh), workers_(&workers), rows_(unknowns) {
  for (const FlatFace& flat : charts.flat()) area_.push_back(flat.area);
  const auto vertices = std::size_t(mesh.vertex_count());
  under_.assign(vertices, 0);
  for (const auto& [ahead, back] : pad_reaches(mesh))
    inverse_.push_back({1 / std::max(size * ahead, roundoff), 1 / std::max(size * back, roundoff)});
  for (std::size_t v = 0; v < vertices; ++v) {
    const bool held = !unknowns.vertex[v] || (!weights.empty() && weights[v] > 0);
    if (!held || !may_have_pad(mesh, Index(v))) continue;
    under_[v] = rows_.vertex[v] = 1;
    any_ = rows_.any_vertex = true;
  }
}

double Pads::reach(std::size_t v) const {
  double farthest = 0;
  for (const Spoke& spoke : mesh_->ring(Index(v))) {
    const Edge& edge = mesh_->edges[spoke.edge];
    const double length =
        (mesh_->positions[edge.vertex[1]] - mesh_->positions[edge.vertex[0]]).norm();
    farthest = std::max(farthest, length / inverse_reach(spoke));
  }
  return farthest;
}

double Hats::inverse_along(const Face& face, std::size_t side, bool from_second) const {
  const Side& at = mesh_.sides[std::size_t(face.first_side) + side];
  return pads_.inverse_[at.edge][at.reversed != from_second ? 1 : 0];
}

Hats::RowHat Hats::row_hat(const Face& face, std::size_t corner, int j) const {
  if (!under(std::size_t(face.vertex[corner]))) return {0, 0, 0};
  const auto size = std::size_t(face.size);
  const double step = 1.0 / grid_.n(), up = j * step, ahead = inverse_along(face, corner, false),
               back = inverse_along(face, (corner + size - 1) % size, true);
  if (face.quad()) {
    const bool along = corner % 2 == 0;  // the next side is along the rows
    const double in_row = along ? ahead : back, across = along ? back : ahead;
    const double factor = std::max(0.0, 1 - (corner < 2 ? up : 1 - up) * across);
    if (corner == 0 || corner == 3) return {factor, 1, -step * in_row};
    return {factor, 1 - in_row, step * in_row};
  }
  switch (corner) {
    case 0: return {1, 1 - up * back, -step * ahead};
    case 1: return {1, 1 - up * ahead - (1 - up) * back, step * back};
    default: return {1, 1 - (1 - up) * ahead, step * (ahead - back)};
  }
}

double Hats::vertex_weight(std::size_t v, const double* weight) const {
  if (weight) return weight[v];
  double share = 0;
  for (const Spoke& spoke : mesh_.ring(Index(v)))
    if (spoke.face >= 0) share += pads_.area_[spoke.face] / mesh_.faces[spoke.face].size;
  return share / (double(grid_.n()) * grid_.n());
}

double Hats::metric_weight_of_edge_point(std::size_t e) const {
  double share = 0;
  for (const Index s : mesh_.edges[e].side)
    if (s >= 0) share += metric_weight_of_face_point(std::size_t(mesh_.sides[s].face));
  return share / 2;
}

double Hats::metric_weight_of_face_point(std::size_t f) const {
  return (mesh_.faces[f].quad() ? 1 : 2) * pads_.area_[f] / (double(grid_.n()) * grid_.n());
}

void Hats::Element::add(double weight, const double* hats, int count) {
  for (int a = 0; a < count; ++a) {
    total[a] += weight * hats[a];
    for (int b = 0; b < count; ++b) mass[a][b] += weight * hats[a] * hats[b];
  }
}

std::vector<Hats::Element> Hats::elements_of_faces(const double* weight) const {
  const int n = grid_.n();
  std::vector<Element> elements(mesh_.faces.size());
  workers_.for_each(elements.size(), element_grain(n), [&](std::size_t f) {
    const Face& face = mesh_.faces[f];
    const double of_metric = metric_weight_of_face_point(f);
    const double* own = weight ? weight + grid_.face_base(Index(f)) : nullptr;
    for (int j = 1; j < n; ++j) {
      stop_in_large_face(j);
      RowHat row[4];
      double hats[4];
      for (int c = 0; c < face.size; ++c) row[c] = row_hat(face, std::size_t(c), j);
      const int last = face.quad() ? n : n - j;
      for (int i = 1; i < last; ++i) {
        for (int c = 0; c < face.size; ++c) hats[c] = row[c](i);
        elements[f].add(own ? *own++ : of_metric, hats, face.size);
      }
    }
  });
  return elements;
}

std::vector<Hats::Element> Hats::elements_of_edges(const double* weight) const {
  const int n = grid_.n();
  std::vector<Element> elements(mesh_.edges.size());
  workers_.for_each(elements.size(), element_grain(n) * std::size_t(n), [&](std::size_t e) {
    const double of_metric = metric_weight_of_edge_point(e);
    const double* own = weight ? weight + grid_.edge_base(Index(e)) : nullptr;
    for (int k = 1; k < n; ++k) {
      const double t = double(k) / n, hats[2] = {hat(e, 0, t), hat(e, 1, 1 - t)};
      elements[e].add(own ? *own++ : of_metric, hats, 2);
    }
  });
  return elements;
}

Hats::Hats(const Pads& pads, const GridLevel& grid, Array<double> omega)
    : pads_(pads),
      grid_(grid),
      mesh_(*pads.mesh_),
      workers_(*pads.workers_),
      weight_(std::move(omega)) {
  const auto vertices = std::size_t(mesh_.vertex_count());
  row_begin_.assign(vertices + 1, 0);
  for (std::size_t v = 0; v < vertices; ++v) {
    Index neighbours = 0;
    if (under(v))
      for (const Spoke& spoke : mesh_.ring(Index(v)))
        neighbours += 1 + (spoke.face >= 0 && mesh_.faces[spoke.face].quad());
    row_begin_[v + 1] = row_begin_[v] + neighbours;
  }
  column_.resize(std::size_t(row_begin_.back()));
  value_.resize(column_.size());
  diagonal_.resize(vertices);
  total_.resize(vertices);
  const std::vector<Element> faces = elements_of_faces(weights()),
                             edges = elements_of_edges(weights());
  workers_.for_each(total_.size(), 256, [&](std::size_t v) {
    diagonal_[v] = total_[v] = 0;
    if (!under(v)) return;
    diagonal_[v] = total_[v] = vertex_weight(v, weights());
    auto at = std::size_t(row_begin_[v]);
    for (const Spoke& spoke : mesh_.ring(Index(v))) {
      // The neighbour along the spoke shares the edge and the faces on both sides of it.
      const Edge& edge = mesh_.edges[spoke.edge];
      const Element& along = edges[spoke.edge];
      const int own = spoke.outward ? 0 : 1;
      double shared = along.mass[0][1];
      diagonal_[v] += along.mass[own][own];
      total_[v] += along.total[own];
      for (const Index s : edge.side) {
        if (s < 0) continue;
        const Side& side = mesh_.sides[s];
        const int next = (side.local + 1) % mesh_.faces[side.face].size;
        shared += faces[side.face].mass[int(side.local)][next];
      }
      column_[at] = edge.vertex[1 - own];
      value_[at++] = shared;
      if (spoke.face < 0) continue;
      const Face& face = mesh_.faces[spoke.face];
      const Element& inside = faces[spoke.face];
      const auto c = std::size_t(spoke.corner);
      diagonal_[v] += inside.mass[c][c];
      total_[v] += inside.total[c];
      if (!face.quad()) continue;
      column_[at] = face.vertex[(c + 2) % 4];
      value_[at++] = inside.mass[c][(c + 2) % 4];
    }
  });
}

template <int N>
void Hats::add_any(const LoadsOf<N>& loads, double* r) const {
  const int n = grid_.n();
  const double* const weight = weights();
  const auto add = [](double* to, double factor, const Eigen::Matrix<double, N, 1>& load) {
    for (int a = 0; a < N; ++a) to[a] += factor * load[a];
  };
  for_each_index(workers_, total_.size(), [&](std::size_t v) {
    if (under(v)) add(r + N * v, vertex_weight(v, weight), loads[v]);
  });
  workers_.for_each(n > 1 ? mesh_.edges.size() : 0, element_grain(n) * std::size_t(n),
                    [&](std::size_t e) {
                      const auto a = std::size_t(mesh_.edges[e].vertex[0]),
                                 b = std::size_t(mesh_.edges[e].vertex[1]);
                      if (!under(a) && !under(b)) return;
                      const auto first = std::size_t(grid_.edge_base(Index(e)));
                      const double of_metric = metric_weight_of_edge_point(e);
                      for (int k = 1; k < n; ++k) {
                        const double t = double(k) / n;
                        const std::size_t p = first + std::size_t(k) - 1;
                        add(r + N * p, weight ? weight[p] : of_metric,
                            hat(e, 0, t) * loads[a] + hat(e, 1, 1 - t) * loads[b]);
                      }
                    });
  workers_.for_each(mesh_.faces.size(), element_grain(n), [&](std::size_t f) {
    const Face& face = mesh_.faces[f];
    auto first = std::size_t(grid_.face_base(Index(f)));
    for (int j = 1; j < n; ++j) {
      stop_in_large_face(j);
      const int inside = std::max(0, (face.quad() ? n : n - j) - 1);
      for (std::size_t c = 0; c < std::size_t(face.size); ++c) {
        RowHat row = row_hat(face, c, j);
        if (row.factor == 0) continue;
        const auto& load = loads[face.vertex[c]];
        double* const to = r + N * first;
        if (weight) {
          for (int i = 0; i < inside; ++i)
            add(to + N * i, weight[first + std::size_t(i)] * row(i + 1), load);
        } else {
          row.factor *= metric_weight_of_face_point(f);
          for (int i = 0; i < inside; ++i) add(to + N * i, row(i + 1), load);
        }
      }
      first += std::size_t(inside);
    }
  });
}

void Hats::add_loads(const Loads& loads, double* r) const { add_any<3>(loads, r); }
void Hats::add_loads(const NormalLoads& loads, double* r) const { add_any<1>(loads, r); }

NormalLoads Hats::gather(const Array<double>& r) const {
  const std::vector<Element> faces = elements_of_faces(r.data()),
                             edges = elements_of_edges(r.data());
  NormalLoads out(total_.size(), Eigen::Matrix<double, 1, 1>::Zero());
  for_each_index(workers_, total_.size(), [&](std::size_t v) {
    if (!under(v)) return;
    double sum = r[v];
    for (const Spoke& spoke : mesh_.ring(Index(v))) {
      sum += edges[spoke.edge].total[spoke.outward ? 0 : 1];
      if (spoke.face >= 0) sum += faces[spoke.face].total[int(spoke.corner)];
    }
    out[v][0] = sum;
  });
  return out;
}

template <int N>
void Hats::multiply_mass(const LoadsOf<N>& loads, LoadsOf<N>& forces) const {
  forces.resize(loads.size());
  workers_.for_each(loads.size(), 1024, [&](std::size_t v) {
    forces[v] = diagonal_[v] * loads[v];
    for (auto k = std::size_t(row_begin_[v]); k < std::size_t(row_begin_[v + 1]); ++k)
      forces[v] += value_[k] * loads[column_[k]];
  });
}

// Chebyshev's semi-iteration on the diagonally scaled matrix.
template <int N>
void Hats::divide_by_mass(const LoadsOf<N>& forces, LoadsOf<N>& loads,
                          const std::vector<double>& compliance_ratio) const {
  constexpr double middle = 0.5 * (largest_mass_eigenvalue + least_mass_eigenvalue),
                   half = 0.5 * (largest_mass_eigenvalue - least_mass_eigenvalue),
                   shape = middle / half;
  LoadsOf<N> step(forces.size(), LoadsOf<N>::value_type::Zero()), product;
  loads.assign(forces.size(), LoadsOf<N>::value_type::Zero());
  double rho = 1 / shape;
  for (int k = 0; k < mass_steps; ++k) {
    multiply_mass(loads, product);
    const double next = 1 / (2 * shape - rho), carry = k == 0 ? 0 : rho * next,
                 gain = k == 0 ? 1 / middle : 2 * next / half;
    for (std::size_t v = 0; v < forces.size(); ++v) {
      if (!under(v)) continue;
      const double r = compliance_ratio.empty() ? 0 : compliance_ratio[v], own = r * total_[v];
      step[v] = carry * step[v] +
                gain / (diagonal_[v] + own) * ((1 + r) * forces[v] - product[v] - own * loads[v]);
      loads[v] += step[v];
    }
    if (k > 0) rho = next;
  }
}

template void Hats::multiply_mass(const Loads&, Loads&) const;
template void Hats::multiply_mass(const NormalLoads&, NormalLoads&) const;
template void Hats::divide_by_mass(const Loads&, Loads&, const std::vector<double>&) const;
template void Hats::divide_by_mass(const NormalLoads&, NormalLoads&,
                                   const std::vector<double>&) const;

}  // namespace fairing
