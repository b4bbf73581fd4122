// SPDX-License-Identifier: GPL-3.0-or-later
#include "stencil/straight.h"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>

#include "mesh/sharp_turn.h"
#include "stencil/fit.h"
#include "stencil/stiffness.h"

namespace fairing {
namespace {

// A direction in space, as a sum of two vectors a and b in its plane, whose places in the chart are
// u and v: its place there.
Vec2 in_chart(const Vec3& direction, const Vec3& a, const Vec3& b, const Vec2& u, const Vec2& v) {
  const double aa = a.dot(a), ab = a.dot(b), bb = b.dot(b), da = direction.dot(a),
               db = direction.dot(b);
  return (da * bb - db * ab) * u + (db * aa - da * ab) * v;  // times a positive factor
}

// Zero if the element is not straight.
class StraightDirection {
 public:
  StraightDirection(const ControlMesh& mesh, const Chart& chart) : mesh_(mesh), chart_(chart) {}

  Vec2 face(Index f) const {
    if (!mesh_.flat.is_straight(f)) return Vec2::Zero();
    const Face& face = mesh_.faces[f];
    const Vec3 a = at(face, 1) - at(face, 0), b = at(face, face.size - 1) - at(face, 0);
    if (!face.quad()) return in_chart(mesh_.flat.along[f], a, b, chart_.ring[0], chart_.ring[1]);
    const Vec3 c = at(face, 2) - at(face, 3), d = at(face, 2) - at(face, 1);
    return in_chart(mesh_.flat.along[f], a + c, b + d, chart_.ring[0], chart_.ring[2]);
  }

  // Like a vertex's, the mean of its faces' directions: a mirrored mesh has the mirrored one.
  Vec2 edge(Index e) const {
    const Edge& edge = mesh_.edges[e];
    if (edge.boundary()) return Vec2::Zero();
    const Side &left = mesh_.sides[edge.side[0]], &right = mesh_.sides[edge.side[1]];
    if (!all_kept(left.face, right.face)) return Vec2::Zero();
    if (mesh_.flat.part[left.face] != mesh_.flat.part[right.face]) return chart_.ring[0];
    Vec2 sum = Vec2::Zero();
    add(left.face, left.local, 0, sum);
    add(right.face, right.local, mesh_.faces[left.face].quad() ? 4 : 3, sum);
    return sum;
  }

  Vec2 vertex(Index v) const {
    const auto ring = mesh_.ring(v);
    const auto kept = [&](const Spoke& s) { return s.face >= 0 && mesh_.flat.is_kept(s.face); };
    if (!std::ranges::all_of(ring, kept)) return Vec2::Zero();
    Vec2 sum = Vec2::Zero();
    std::size_t place = 0;
    for (const Spoke& spoke : ring) {
      add(spoke.face, spoke.corner, place, sum);
      place += mesh_.faces[spoke.face].quad() ? 2 : 1;
    }
    return sum;
  }

 private:
  const Vec3& at(const Face& face, int corner) const {
    return mesh_.positions[face.vertex[corner]];
  }
  // Adds a face's direction to those of others around the centre, which is at its corner c. `place`:
  // the next corner's in the ring.
  void add(Index f, int c, std::size_t place, Vec2& sum) const {
    if (!mesh_.flat.is_straight(f)) return;
    const Face& face = mesh_.faces[f];
    const Vec3 a = at(face, (c + 1) % face.size) - at(face, c),
               b = at(face, (c + face.size - 1) % face.size) - at(face, c);
    const std::size_t next = (place + (face.quad() ? 2 : 1)) % chart_.ring.size();
    const Vec2 own =
        in_chart(mesh_.flat.along[f], a, b, chart_.ring[place], chart_.ring[next]).normalized();
    sum += sum.dot(own) < 0 ? Vec2(-own) : own;
  }
  bool all_kept(Index f, Index g) const {
    return mesh_.flat.is_kept(f) && mesh_.flat.is_kept(g) &&
           (mesh_.flat.is_straight(f) || mesh_.flat.is_straight(g));
  }

  const ControlMesh& mesh_;
  const Chart& chart_;
};

Vec2 direction_of(const ControlMesh& mesh, const Element& element, const Chart& chart) {
  const StraightDirection straight(mesh, chart);
  switch (element.kind) {
    case RunKind::vertex: return straight.vertex(element.element);
    case RunKind::edge: return straight.edge(element.element);
    default: return straight.face(element.element);
  }
}

// How far the ring extends to the left of a line through the centre.
double reach(const Chart& chart, const Vec2& line) {
  double most = 0;
  for (const Vec2& at : chart.ring) most = std::max(most, line.x() * at.y() - line.y() * at.x());
  return most;
}

// The stiffness across a line with a stiff face on its left: the harmonic mean by the widths of
// both sides, as a moment there bends the right one alone.
double across_line(const Chart& chart, const Vec2& line) {
  const double own = reach(chart, line), other = reach(chart, -line);
  return (own + other) / (own / flat_stiffness + other);
}

// Which side of an edge off the border alone is stiff across it: 1 left, -1 right, 0 none.
int stiffer_side(const ControlMesh& mesh, Index e) {
  const auto [a, b] = mesh.edges[e].vertex;
  const Vec3 line = mesh.positions[b] - mesh.positions[a];
  return mesh.flat.is_stiff(mesh.face_beside(e, 0), line) -
         mesh.flat.is_stiff(mesh.face_beside(e, 1), line);
}

// The side of an element of an edge off the border, from the row of its left face on.
StiffSide side_of_edge(const ControlMesh& mesh, Index e, const Chart& chart) {
  const int more = mesh.edges[e].boundary() ? 0 : stiffer_side(mesh, e);
  if (more == 0) return {};
  const std::size_t back = mesh.faces[mesh.face_beside(e, 0)].quad() ? 4 : 3;
  return more > 0 ? StiffSide{chart.ring[0], 1, back}
                  : StiffSide{-chart.ring[0], back + 1, chart.ring.size()};
}

// The same of a vertex with two kinds of faces, each on one side of a line of edges.
StiffSide side_of_vertex(const ControlMesh& mesh, Index v, const Chart& chart) {
  const auto ring = mesh.ring(v);
  if (!mesh.interior(v)) return {};
  std::size_t place = 0, begin = 0, end = 0;
  int changes = 0;
  for (const Spoke& spoke : ring) {
    const int more = stiffer_side(mesh, spoke.edge) * (spoke.outward ? 1 : -1);
    if (more != 0) ++changes;
    if (more > 0) begin = place;
    if (more < 0) end = place;
    place += mesh.faces[spoke.face].quad() ? 2 : 1;
  }
  const Vec2 first = chart.ring[begin].normalized(), last = chart.ring[end].normalized();
  if (changes != 2 || first.dot(last) > -sharp_turn) return {};
  return {first - last, begin + 1, end > begin ? end : end + place};
}

// The second difference in one direction, from the fit's coefficients.
Vec3 second_in(const Vec2& direction) {
  const double x = direction.x(), y = direction.y(), square = direction.squaredNorm();
  return root_half * Vec3(1, (x * x - y * y) / square, 2 * x * y / square);
}

// Multiplies the stiffness in one direction, by its second difference f_dd in the fit's coefficients.
void multiply(double stiffness, const Vec2& direction, std::span<std::array<double, 3>> hessians) {
  const double square = direction.squaredNorm();
  if (!(square > 0)) return;
  const Vec3 second = second_in(direction);
  for (auto& numbers : hessians) {
    Eigen::Map<Vec3> hessian(numbers.data());
    hessian += (std::sqrt(stiffness) - 1) * second.dot(hessian) * second;
  }
}

}  // namespace

StiffSide stiff_side(const ControlMesh& mesh, const Element& element, const Chart& chart) {
  if (mesh.flat.along.empty()) return {};
  switch (element.kind) {
    case RunKind::vertex: return side_of_vertex(mesh, element.element, chart);
    case RunKind::edge: return side_of_edge(mesh, element.element, chart);
    default: return {};
  }
}

double shorten(const StiffSide& side, Chart& chart) {
  const double own = reach(chart, side.line), other = reach(chart, -side.line);
  if (!(own > other)) return 1;
  const double share = other / own;
  for (std::size_t j = side.begin; j < side.end; ++j) chart.ring[j % chart.ring.size()] *= share;
  chart.area *= 2 * other / (own + other);
  return share;
}

Coefficients basis_beside(const StiffSide& side, const Chart& chart, std::size_t j, double share) {
  const Vec2 at = share * chart.ring[j];
  Coefficients out = basis(at);
  const std::size_t size = chart.ring.size(), from = (j + size - side.begin) % size;
  if (from >= side.end - side.begin) return out;
  const Vec2 across = Vec2(-side.line.y(), side.line.x()).normalized();
  out.tail<3>() -= 0.5 * at.dot(across) * at.dot(across) * second_in(across);
  return out;
}

FitRows fit_beside(const StiffSide& side, const Chart& chart) {
  Eigen::Matrix<double, Eigen::Dynamic, 5> terms(Eigen::Index(chart.ring.size()), 5);
  for (std::size_t j = 0; j < chart.ring.size(); ++j)
    terms.row(Eigen::Index(j)) = basis_beside(side, chart, j, 1).transpose();
  return terms.completeOrthogonalDecomposition().pseudoInverse();
}

void stiffen_straight(const ControlMesh& mesh, const Element& element, const Chart& chart,
                      std::span<std::array<double, 3>> hessians) {
  if (!mesh.flat.along.empty())
    multiply(flat_stiffness, direction_of(mesh, element, chart), hessians);
}

void stiffen_across(const StiffSide& side, const Chart& chart,
                    std::span<std::array<double, 3>> hessians) {
  multiply(across_line(chart, side.line), {-side.line.y(), side.line.x()}, hessians);
}

}  // namespace fairing
