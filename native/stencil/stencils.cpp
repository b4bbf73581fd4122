// SPDX-License-Identifier: GPL-3.0-or-later
#include "stencil/stencils.h"

#include <cmath>
#include <utility>

#include "parallel/cancel.h"
#include "stencil/straight.h"

namespace fairing {
namespace {

Element element_at(const ControlMesh& mesh, std::size_t element) {
  const auto vertices = std::size_t(mesh.vertex_count()), edges = mesh.edges.size();
  if (element < vertices) return {RunKind::vertex, Index(element)};
  if (element < vertices + edges) return {RunKind::edge, Index(element - vertices)};
  return {RunKind::face_row, Index(element - vertices - edges)};
}

Chart chart_of(const ChartMaker& charts, const Element& element) {
  switch (element.kind) {
    case RunKind::vertex: return charts.vertex(element.element);
    case RunKind::edge: return charts.edge(element.element);
    default: return charts.face(element.element);
  }
}

// The divided differences of second order of an element's points, times the root of its area.
void set_differences(const Element& element, double area, const FitRows& rows,
                     std::span<Stencils::Column> energy) {
  const std::size_t size = energy.size();
  const double root_weight = std::sqrt(area);
  const auto number = [&](std::size_t j, Eigen::Index c) { return rows(c + 2, Eigen::Index(j)); };
  const bool in_face = element.kind == RunKind::face_row;
  for (std::size_t j = 0; j < size; ++j)
    for (Eigen::Index c = 0; c < 3; ++c)
      energy[j][std::size_t(c)] =
          root_weight *
          (in_face ? 0.5 * (number(j, c) + number((j + size / 2) % size, c)) : number(j, c));
}

void set_energy(const ControlMesh& mesh, const Element& element, const StiffSide& side, Chart chart,
                const FitRows& rows, std::span<Stencils::Column> energy) {
  const double share = shorten(side, chart);
  set_differences(element, chart.area, side.any() ? fit(chart) : rows, energy);
  for (std::size_t j = side.begin; j < side.end; ++j)
    for (double& each : energy[j % energy.size()]) each *= share;
  stiffen_straight(mesh, element, chart, energy);
  stiffen_across(side, chart, energy);
}

// The fit, and the basis half-way to each neighbour.
void set_transfer(const StiffSide& side, const Chart& chart, const FitRows& usual, float* rows,
                  float* half) {
  const FitRows fitted = side.any() ? fit_beside(side, chart) : usual;
  for (std::size_t j = 0; j < chart.ring.size(); ++j) {
    const Coefficients at = basis_beside(side, chart, j, 0.5);
    for (std::size_t c = 0; c < 5; ++c) {
      rows[5 * j + c] = float(fitted(Eigen::Index(c), Eigen::Index(j)));
      half[5 * j + c] = float(at(Eigen::Index(c)));
    }
  }
}

void fill(const ControlMesh& mesh, const ChartMaker& charts, std::size_t e, Stencils& s) {
  const std::size_t first = s.begin[e], size = s.begin[e + 1] - first;
  const Element element = element_at(mesh, e);
  const bool in_face = element.kind == RunKind::face_row;
  std::fill_n(s.energy.data() + first, size, Stencils::Column{});
  for (Array<float>* numbers : {&s.rows, &s.half})
    if (!in_face) std::fill_n(numbers->data() + 5 * first, 5 * size, 0.0f);
  s.has_fit[e] = has_fit(mesh, element);
  if (!s.has_fit[e]) return;
  Chart chart = chart_of(charts, element);
  const FitRows rows = fit(chart);
  const StiffSide side = stiff_side(mesh, element, chart);
  if (!in_face) set_transfer(side, chart, rows, &s.rows[5 * first], &s.half[5 * first]);
  set_energy(mesh, element, side, std::move(chart), rows, {s.energy.data() + first, size});
}

}  // namespace

Stencils make_stencils(const ControlMesh& mesh, const ChartMaker& charts, Workers& workers,
                       const MembraneOptions& membrane) {
  const std::size_t rings = std::size_t(mesh.vertex_count()) + mesh.edges.size(),
                    elements = rings + mesh.faces.size();
  Stencils s;
  s.begin.assign(1, 0);
  s.begin.reserve(elements + 1);
  for (const std::size_t e : Cancellable(elements)) {
    s.begin.push_back(s.begin.back() + neighbours(mesh, element_at(mesh, e)));
  }
  s.has_fit.resize(elements);
  s.energy.resize(s.begin[elements]);
  s.rows.resize(5 * s.begin[rings]);
  s.half.resize(5 * s.begin[rings]);
  workers.for_each(elements, 64, [&](std::size_t e) { fill(mesh, charts, e, s); });
  s.tension = make_membrane(mesh, charts, s.begin, membrane);
  return s;
}

}  // namespace fairing
