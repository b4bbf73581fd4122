// SPDX-License-Identifier: GPL-3.0-or-later
#include "energy/connection.h"

#include <Eigen/Geometry>
#include <cmath>

#include "execution/cancel.h"

namespace fairing {
namespace {

// What is known of one point of a ring.
struct TensorPoint {
  const double *x, *normal, *axis, *tensor;
  double area;
};

struct TurnedEdge {
  double weight;        // clamped
  double cosine, sine;  // of twice the angle from the neighbour's chart to the point's
};

Vec2 direction(const Vec3& along, const TensorPoint& p) {
  const Eigen::Map<const Vec3> normal(p.normal), axis(p.axis);
  return Vec2(along.dot(axis), along.dot(normal.cross(axis))).normalized();
}

// The turn between two charts, by the edge that both see (its two directions there differ by half a turn, which twice the
// angle does not notice).
TurnedEdge edge_between(const TensorPoint& a, const TensorPoint& b, double weight) {
  if (!(weight > 0) || !(b.area > 0)) return {0, 1, 0};
  const Vec3 along = Eigen::Map<const Vec3>(b.x) - Eigen::Map<const Vec3>(a.x);
  const Vec2 p = direction(along, a), q = direction(along, b);
  const double c = p.dot(q), s = q.x() * p.y() - q.y() * p.x();
  if (!std::isfinite(c) || !std::isfinite(s)) return {0, 1, 0};
  return {weight, c * c - s * s, 2 * c * s};
}

// Reads the weights of a run's point i, writes its rows; returns the energy of half its edges.
template <class Neighbour>
double set_point(const RowRun<float>& run, std::size_t i, const TensorPoint& own, Neighbour&& neighbour,
                 double* force) {
  double energy = 0, sum = 0, moment[3] = {0, 0, 0};
  const double root = std::sqrt(own.area);
  for (int s = 1; s < run.slots; ++s) {
    const TensorPoint other = neighbour(s);
    const TurnedEdge edge =
        own.area > 0 ? edge_between(own, other, double(run.at(0, s, i))) : TurnedEdge{0, 1, 0};
    const double scale = edge.weight > 0 ? edge.weight / (root * std::sqrt(other.area)) : 0;
    run.at(0, s, i) = float(-scale);
    run.at(1, s, i) = float(-scale * edge.cosine);
    run.at(2, s, i) = float(-scale * edge.sine);
    if (!(edge.weight > 0)) continue;
    const double *m = own.tensor, *o = other.tensor;
    const double d[3] = {m[0] - o[0], m[1] - (edge.cosine * o[1] - edge.sine * o[2]),
                         m[2] - (edge.sine * o[1] + edge.cosine * o[2])};
    for (int c = 0; c < 3; ++c) {
      moment[c] += edge.weight * d[c];
      energy += 0.5 * edge.weight * d[c] * d[c];
    }
    sum += edge.weight;
  }
  run.at(0, 0, i) = own.area > 0 ? float(sum / own.area) : 0.0f;
  for (int c = 0; c < 3; ++c) force[c] = own.area > 0 ? moment[c] / root : 0.0;
  return energy;
}

// z <- the rows of a run on y, whose neighbours' tensors are at y[s] + 3 i.
template <class T>
void apply_run(const RowRun<const float>& run, T damping, const T* const* y, T* z) {
  for (std::size_t i = 0; i < run.count; ++i) {
    const T* own = y[0] + 3 * i;
    const T diagonal = T(run.at(0, 0, i)) + damping;
    for (int c = 0; c < 3; ++c) z[3 * i + std::size_t(c)] = diagonal * own[c];
  }
  for (int s = 1; s < run.slots; ++s) {
    const float *weight = &run.at(0, s, 0), *cosine = &run.at(1, s, 0), *sine = &run.at(2, s, 0);
    const T* from = y[s];
    for (std::size_t i = 0; i < run.count; ++i) {
      const T* o = from + 3 * i;
      z[3 * i] += T(weight[i]) * o[0];
      z[3 * i + 1] += T(cosine[i]) * o[1] - T(sine[i]) * o[2];
      z[3 * i + 2] += T(sine[i]) * o[1] + T(cosine[i]) * o[2];
    }
  }
}

}  // namespace

double Connection::set(const Surface& surface, const double* tensor, Workers& workers, double* force) {
  const Lattice& lattice = rows_.lattice();
  const ControlMesh& mesh = lattice.mesh();
  const int n = lattice.n();
  std::vector<double> vertex(std::size_t(mesh.vertex_count()), 0.0), edge(mesh.edges.size(), 0.0),
      face(mesh.faces.size(), 0.0);
  workers.for_parts(vertex.size(), 256, [&](std::size_t begin, std::size_t end) {
    std::vector<Index> ring;
    for (std::size_t v = begin; v < end; ++v) {
      ring.assign(1, Index(v));
      visit_ring(lattice, Index(v), [&](Index p, std::size_t) { ring.push_back(p); });
      const auto point = [&](int s) -> TensorPoint {
        const std::size_t p = std::size_t(ring[std::size_t(s)]);
        return {surface.x + 3 * p, surface.normal + 3 * p, surface.axis + 3 * p, tensor + 3 * p,
                surface.area[p]};
      };
      vertex[v] = set_point(rows_.vertex(Index(v)), 0, point(0), point, force + 3 * v);
    }
  });
  workers.for_parts(
      n > 1 ? mesh.edges.size() : 0, element_grain(n) * std::size_t(n),
      [&](std::size_t begin, std::size_t end) {
        std::vector<double> room[5];
        for (std::size_t e = begin; e < end; ++e) {
          const EdgeRingLanes ring(mesh, Index(e));
          const EdgeLanes<double> x(lattice, surface.x, Index(e), room[0]),
              normal(lattice, surface.normal, Index(e), room[1]),
              axis(lattice, surface.axis, Index(e), room[2]), m(lattice, tensor, Index(e), room[3]);
          const EdgeLanes<double, 1> area(lattice, surface.area, Index(e), room[4]);
          const RowRun<float> run = rows_.edge(Index(e));
          double* to = force + 3 * std::size_t(lattice.edge_base(Index(e)));
          for (int k = 1; k < n; ++k) {
            const auto point = [&](int s) -> TensorPoint {
              const int lane = s == 0 ? 0 : ring.lane[s - 1], at = k + (s == 0 ? 0 : ring.at[s - 1]);
              return {x.lane[lane] + 3 * at, normal.lane[lane] + 3 * at, axis.lane[lane] + 3 * at,
                      m.lane[lane] + 3 * at, area.lane[lane][at]};
            };
            edge[e] += set_point(run, std::size_t(k - 1), point(0), point, to + 3 * (k - 1));
          }
        }
      });
  workers.for_parts(face.size(), element_grain(n), [&](std::size_t begin, std::size_t end) {
    const std::size_t size = closed_size(true, std::size_t(n));
    std::vector<double> x(3 * size), normal(3 * size), axis(3 * size), m(3 * size), area(size);
    for (std::size_t f = begin; f < end; ++f) {
      const bool quad = mesh.faces[f].quad();
      const auto steps = face_ring(quad);
      gather_face(lattice, surface.x, Index(f), x.data());
      gather_face(lattice, surface.normal, Index(f), normal.data());
      gather_face(lattice, surface.axis, Index(f), axis.data());
      gather_face(lattice, tensor, Index(f), m.data());
      gather_face<1>(lattice, surface.area, Index(f), area.data());
      double* to = force + 3 * std::size_t(lattice.face_base(Index(f)));
      for (int j = 1; j < n; ++j) {
        stop_in_large_face(j);
        const RowRun<float> run = rows_.face(Index(f), j);
        for (std::size_t i = 0; i < run.count; ++i, to += 3) {
          const auto point = [&](int s) -> TensorPoint {
            const LatticePoint d = s == 0 ? LatticePoint{0, 0} : steps[std::size_t(s - 1)];
            const std::size_t p =
                closed_row(quad, std::size_t(n), std::size_t(j + d.j)) + i + 1 + std::size_t(d.i);
            return {&x[3 * p], &normal[3 * p], &axis[3 * p], &m[3 * p], area[p]};
          };
          face[f] += set_point(run, i, point(0), point, to);
        }
      }
    }
  });
  double total = 0;
  for (const auto& part : {vertex, edge, face})
    for (const double e : part) total += e;
  return total;
}

template <class T>
void Connection::apply(double damping, Workers& workers, const T* y, T* z) const {
  const Lattice& lattice = rows_.lattice();
  const ControlMesh& mesh = lattice.mesh();
  const int n = lattice.n();
  workers.for_parts(std::size_t(mesh.vertex_count()), 256, [&](std::size_t begin, std::size_t end) {
    std::vector<const T*> from;
    for (std::size_t v = begin; v < end; ++v) {
      from.assign(1, y + 3 * v);
      visit_ring(lattice, Index(v), [&](Index p, std::size_t) { from.push_back(y + 3 * std::size_t(p)); });
      apply_run(rows_.vertex(Index(v)), T(damping), from.data(), z + 3 * v);
    }
  });
  workers.for_parts(n > 1 ? mesh.edges.size() : 0, element_grain(n) * std::size_t(n),
                    [&](std::size_t begin, std::size_t end) {
                      std::vector<T> room;
                      for (std::size_t e = begin; e < end; ++e) {
                        const EdgeRingLanes ring(mesh, Index(e));
                        const EdgeLanes<T> lanes(lattice, y, Index(e), room);
                        const T* from[most_slots] = {lanes.lane[0] + 3};
                        for (int j = 0; j < ring.size; ++j)
                          from[j + 1] = lanes.lane[ring.lane[j]] + 3 * (1 + ring.at[j]);
                        apply_run(rows_.edge(Index(e)), T(damping), from,
                                  z + 3 * std::size_t(lattice.edge_base(Index(e))));
                      }
                    });
  workers.for_parts(mesh.faces.size(), element_grain(n), [&](std::size_t begin, std::size_t end) {
    T* const closed = room_in(thread_scratch<T>().gathered, 3 * closed_size(true, std::size_t(n)));
    for (std::size_t f = begin; f < end; ++f) {
      const bool quad = mesh.faces[f].quad();
      gather_face(lattice, y, Index(f), closed);
      T* to = z + 3 * std::size_t(lattice.face_base(Index(f)));
      const auto at = [&](int i, int j) {
        return closed + 3 * (closed_row(quad, std::size_t(n), std::size_t(j)) + std::size_t(i));
      };
      for (int j = 1; j < n; ++j) {
        const RowRun<const float> run = rows_.face(Index(f), j);
        const T* from[most_slots] = {at(1, j)};
        int s = 1;
        for (const LatticePoint d : face_ring(quad)) from[s++] = at(1 + d.i, j + d.j);
        apply_run(run, T(damping), from, to);
        to += 3 * run.count;
      }
    }
  });
}

template void Connection::apply<float>(double, Workers&, const float*, float*) const;
template void Connection::apply<double>(double, Workers&, const double*, double*) const;

}  // namespace fairing
