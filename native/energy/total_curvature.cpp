// SPDX-License-Identifier: GPL-3.0-or-later
#include "energy/total_curvature.h"

#include "energy/point_curvature.h"
#include "lattice/accumulate.h"
#include "lattice/ring.h"

namespace fairing {
namespace {

// One ring after another, in memory that is taken once.
class Measure {
 public:
  void start(const double* centre) {
    centre_ = centre;
    offset_.clear();
    far_.clear();
  }
  void add(const double* p, bool far) {
    offset_.emplace_back(p[0] - centre_[0], p[1] - centre_[1], p[2] - centre_[2]);
    far_.push_back(far);
  }
  double energy() {
    const PointCurvature point = point_curvature({offset_, far_}, chart_);
    return point.area * point.density();
  }

 private:
  const double* centre_ = nullptr;
  std::vector<Vec3> offset_;
  std::vector<std::uint8_t> far_;
  SurfaceChart chart_;
};

double vertex_energy(const Lattice& lattice, Index v, const double* x, Measure& measure) {
  measure.start(x + 3 * std::size_t(v));
  visit_ring(lattice, v,
             [&](Index point, std::size_t slot) { measure.add(x + 3 * std::size_t(point), slot % 2 == 1); });
  return measure.energy();
}

double edge_energy(const Lattice& lattice, Index e, const double* x, Measure& measure,
                   std::vector<double>& scratch) {
  const EdgeRingLanes ring(lattice.mesh(), e);
  const EdgeLanes<double> lanes(lattice, x, e, scratch);
  double sum = 0;
  for (int k = 1; k < lattice.n(); ++k) {
    measure.start(lanes.lane[0] + 3 * k);
    for (int j = 0; j < ring.size; ++j)
      measure.add(lanes.lane[ring.lane[j]] + 3 * (ring.at[j] + k), ring.far[j]);
    sum += measure.energy();
  }
  return sum;
}

double face_energy(const Lattice& lattice, Index f, const double* x, Measure& measure,
                   std::vector<double>& closed) {
  constexpr LatticePoint triangle[] = {{1, 0}, {0, 1}, {-1, 1}, {-1, 0}, {0, -1}, {1, -1}};
  constexpr LatticePoint quad[] = {{1, 0}, {1, 1}, {0, 1}, {-1, 1}, {-1, 0}, {-1, -1}, {0, -1}, {1, -1}};
  const bool four = lattice.mesh().faces[std::size_t(f)].quad();
  const std::span<const LatticePoint> ring = four ? std::span<const LatticePoint>(quad) : triangle;
  const int n = lattice.n();
  closed.resize(3 * closed_size(true, std::size_t(n)));
  gather_face(lattice, x, f, closed.data());
  const auto at = [&](int i, int j) {
    return closed.data() + 3 * (closed_row(four, std::size_t(n), std::size_t(j)) + std::size_t(i));
  };
  double sum = 0;
  for (int j = 1; j < n; ++j)
    for (int i = 1; i < (four ? n : n - j); ++i) {
      measure.start(at(i, j));
      for (const LatticePoint d : ring) measure.add(at(i + d.i, j + d.j), four && d.i * d.j != 0);
      sum += measure.energy();
    }
  return sum;
}

}  // namespace

double total_curvature(const Lattice& lattice, Workers& workers, const double* x) {
  const ControlMesh& mesh = lattice.mesh();
  const int n = lattice.n();
  // One number an element, added up in their order: the number of threads leaves no trace.
  std::vector<double> vertex(std::size_t(mesh.vertex_count()), 0.0), edge(mesh.edges.size(), 0.0),
      face(mesh.faces.size(), 0.0);
  workers.for_parts(vertex.size(), 256, [&](std::size_t begin, std::size_t end) {
    Measure measure;
    for (std::size_t v = begin; v < end; ++v)
      if (!mesh.feature_vertex[v] && mesh.interior(Index(v)) && mesh.vertex_place(Index(v)) == Place::inside)
        vertex[v] = vertex_energy(lattice, Index(v), x, measure);
  });
  workers.for_parts(n > 1 ? edge.size() : 0, element_grain(n) * std::size_t(n),
                    [&](std::size_t begin, std::size_t end) {
                      Measure measure;
                      std::vector<double> scratch;
                      for (std::size_t e = begin; e < end; ++e)
                        if (!mesh.feature_edge[e] && !mesh.edges[e].boundary() &&
                            mesh.edge_place(Index(e)) == Place::inside)
                          edge[e] = edge_energy(lattice, Index(e), x, measure, scratch);
                    });
  workers.for_parts(n > 1 ? face.size() : 0, element_grain(n), [&](std::size_t begin, std::size_t end) {
    Measure measure;
    std::vector<double> scratch;
    for (std::size_t f = begin; f < end; ++f)
      if (mesh.face_place(Index(f)) == Place::inside)
        face[f] = face_energy(lattice, Index(f), x, measure, scratch);
  });
  double total = 0;
  for (const auto& part : {vertex, edge, face})
    for (const double e : part) total += e;
  return total;
}

}  // namespace fairing
