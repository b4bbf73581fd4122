// SPDX-License-Identifier: GPL-3.0-or-later
#include "stencil/membrane.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/roundoff.h"
#include "parallel/cancel.h"

namespace fairing {
namespace {

// Strength at tension 1: swelling is gone on the meshes that tension is for, and cusps at control
// vertices begin to cost more than more tension gains.
constexpr double tautest = 30;

// For one face the weights of the directions of its grid (face_directions() in grid/ring.h).
struct FaceWeights {
  std::array<double, 4> direction{};
  bool quad = false;

  // Of edges along side s inside the face.
  double side(int s) const {
    constexpr std::size_t triangle[3] = {0, 2, 1};
    return direction[quad ? std::size_t(s % 2 * 2) : triangle[s]];
  }
  // Of a quad's diagonals from corner c to the opposite one.
  double diagonal(int c) const { return direction[c % 2 == 0 ? 1 : 3]; }
};

// Two equal triangles share each grid edge, each with half the cotangent of its angle. Sines below
// `roundoff` are replaced by it.
FaceWeights triangle_weights(const FlatFace& flat) {
  const auto square = [&](std::size_t s) { return flat.length[s] * flat.length[s]; };
  const double longest = std::max({square(0), square(1), square(2)}),
               area = std::max(flat.area, roundoff * longest);
  // at corner c, between sides c and c + 2
  const auto cotangent = [&](std::size_t c) {
    return (square(c) + square((c + 2) % 3) - square((c + 1) % 3)) / (4 * area);
  };
  return {{cotangent(2), cotangent(1), cotangent(0), 0}, false};
}

FaceWeights quad_weights(const FlatFace& flat) {
  const double a = flat.length[0], b = flat.length[1],
               sine = std::max(std::sin(flat.angle[0]), roundoff),
               cotangent = std::cos(flat.angle[0]) / sine;
  return {{b / (a * sine), -0.5 * cotangent, a / (b * sine), 0.5 * cotangent}, true};
}

std::vector<FaceWeights> weigh(const ControlMesh& mesh, const std::vector<FlatFace>& flat) {
  std::vector<FaceWeights> out;
  out.reserve(flat.size());
  for (const std::size_t f : Cancellable(flat.size())) {
    const bool quad = mesh.faces[f].quad();
    out.push_back(quad ? quad_weights(flat[f]) : triangle_weights(flat[f]));
    if (mesh.face_part(Index(f)) == RegionPart::outside) out.back().direction = {};
  }
  return out;
}

// The weight of edges along a control edge: the sum over both faces.
double along(const ControlMesh& mesh, const std::vector<FaceWeights>& faces, Index e) {
  double sum = 0;
  for (const Index s : mesh.edges[e].side) {
    if (s < 0) continue;
    const Side& side = mesh.sides[s];
    sum += 0.5 * faces[side.face].side(side.local);
  }
  return sum;
}

// In the order of ChartMaker::edge().
void fill_edge(const ControlMesh& mesh, const std::vector<FaceWeights>& faces, Index e,
               double* to) {
  const double own = along(mesh, faces, e);
  for (const Index s : mesh.edges[e].side) {
    *to++ = own;
    if (s < 0) continue;
    const Side& side = mesh.sides[s];
    const FaceWeights& face = faces[side.face];
    const int corner = side.local;
    if (face.quad) {
      *to++ = face.diagonal(corner);
      *to++ = face.side(corner + 1);
      *to++ = face.diagonal(corner + 1);
    } else {
      *to++ = face.side((corner + 2) % 3);
      *to++ = face.side((corner + 1) % 3);
    }
  }
}

// In the order of ChartMaker::vertex().
void fill_vertex(const ControlMesh& mesh, const std::vector<FaceWeights>& faces, Index v,
                 double* to) {
  for (const Spoke& spoke : mesh.ring(v)) {
    *to++ = along(mesh, faces, spoke.edge);
    if (spoke.face >= 0 && faces[spoke.face].quad) *to++ = faces[spoke.face].diagonal(spoke.corner);
  }
}

}  // namespace

// A membrane of strength t removes a share of about t / (t + c) of the surface's swelling; c is 14
// for the thin plate, 6 for total curvature and less for bubbles (measured: volumes of two
// animals). With c = 10 equal steps of `tension` remove about equal shares.
double MembraneOptions::strength() const { return tautest * tension / (4 - 3 * tension); }

double mean_edge(const ControlMesh& mesh, const std::vector<FlatFace>& flat) {
  double sum = 0;
  std::size_t count = 0;
  for (std::size_t e = 0; e < mesh.edges.size(); ++e) {
    if (mesh.edge_part(Index(e)) == RegionPart::outside) continue;
    sum += edge_length(mesh, flat, Index(e));
    ++count;
  }
  return count > 0 ? sum / double(count) : 1;
}

Array<double> make_membrane(const ControlMesh& mesh, const ChartMaker& charts,
                            const std::vector<std::size_t>& begin, const MembraneOptions& options) {
  if (!(options.tension > 0)) return {};
  std::vector<FaceWeights> faces = weigh(mesh, charts.flat());
  const double length = mean_edge(mesh, charts.flat()),
               t = options.strength() * options.edge_ratio * options.edge_ratio,
               factor = 0.5 * t / (length * length);
  for (FaceWeights& face : faces)
    for (double& w : face.direction) w *= factor;
  Array<double> out(begin.back());
  const std::size_t* of_element = begin.data();
  for (Index v = 0; v < mesh.vertex_count(); ++v)
    fill_vertex(mesh, faces, v, out.data() + *of_element++);
  for (std::size_t e = 0; e < mesh.edges.size(); ++e)
    fill_edge(mesh, faces, Index(e), out.data() + *of_element++);
  for (const FaceWeights& face : faces) {
    double* to = out.data() + *of_element++;
    const std::size_t directions = face.quad ? 4 : 3;
    for (std::size_t k = 0; k < 2 * directions; ++k) to[k] = face.direction[k % directions];
  }
  return out;
}

}  // namespace fairing
