// SPDX-License-Identifier: GPL-3.0-or-later
#include "stencil/metric.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "parallel/cancel.h"
#include "stencil/ridges.h"

namespace fairing {
namespace {

// The angle between sides a and b of a triangle with third side c.
double angle_between(double a, double b, double c) {
  return std::acos(std::clamp((a * a + b * b - c * c) / (2 * a * b), -1.0, 1.0));
}

// Kahan's stable form of Heron's area.
double triangle_area(double a, double b, double c) {
  if (a < b) std::swap(a, b);
  if (a < c) std::swap(a, c);
  if (b < c) std::swap(b, c);
  return 0.25 *
         std::sqrt(std::max(0.0, (a + (b + c)) * (c - (a - b)) * (c + (a - b)) * (a + (b - c))));
}

FlatFace flat_triangle(const std::array<Vec3, 3>& p, double exponent) {
  std::array<double, 3> l;
  for (std::size_t s = 0; s < 3; ++s) l[s] = std::pow((p[(s + 1) % 3] - p[s]).norm(), exponent);
  FlatFace flat{};
  for (std::size_t s = 0; s < 3; ++s) {
    flat.length[s] = l[s];
    flat.angle[s] = angle_between(l[s], l[(s + 2) % 3], l[(s + 1) % 3]);
  }
  flat.area = triangle_area(l[0], l[1], l[2]);
  return flat;
}

FlatFace flat_quad(const std::array<Vec3, 4>& p, const std::array<double, 2>& shares,
                   double exponent) {
  Vec3 u = 0.5 * ((p[1] - p[0]) + (p[2] - p[3])), v = 0.5 * ((p[3] - p[0]) + (p[2] - p[1]));
  if (shares[0] != 1) u *= std::pow(shares[0], 1 / exponent);
  if (shares[1] != 1) v *= std::pow(shares[1], 1 / exponent);
  const double a = std::pow(u.norm(), exponent), b = std::pow(v.norm(), exponent);
  const double plus = std::pow((u + v).norm(), exponent),
               minus = std::pow((u - v).norm(), exponent);
  const double angle =
      0.5 * ((std::numbers::pi - angle_between(a, b, plus)) + angle_between(a, b, minus));
  FlatFace flat;
  flat.length = {a, b, a, b};
  flat.angle = {angle, std::numbers::pi - angle, angle, std::numbers::pi - angle};
  flat.area = a * b * std::sin(angle);
  return flat;
}

}  // namespace

std::vector<FlatFace> flatten(const ControlMesh& mesh, double exponent) {
  std::vector<FlatFace> flat;
  flat.reserve(mesh.faces.size());
  const std::vector<std::array<double, 2>> shares = ridge_shares(mesh, exponent);
  for (const Face& face : mesh.faces) {
    stop_if_cancelled(flat.size());
    const auto at = [&](std::size_t c) -> const Vec3& { return mesh.positions[face.vertex[c]]; };
    flat.push_back(face.quad()
                       ? flat_quad({at(0), at(1), at(2), at(3)}, shares[flat.size()], exponent)
                       : flat_triangle({at(0), at(1), at(2)}, exponent));
  }
  return flat;
}

double edge_length(const ControlMesh& mesh, const std::vector<FlatFace>& flat, Index edge) {
  double sum = 0;
  int count = 0;
  for (const Index s : mesh.edges[edge].side) {
    if (s < 0) continue;
    const Side& side = mesh.sides[s];
    sum += flat[side.face].length[side.local];
    ++count;
  }
  return sum / count;
}

}  // namespace fairing
