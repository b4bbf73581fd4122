// SPDX-License-Identifier: GPL-3.0-or-later
#include "curvature/connection.h"

#include <Eigen/Geometry>
#include <cmath>
#include <utility>

#include "parallel/cancel.h"

namespace fairing {
namespace {

// One point of a ring.
struct TensorPoint {
  const double *x, *normal, *axis, *tensor;
  double area;
  double root;  // of the point's stiffness
};

struct TurnedEdge {
  double weight;        // clamped
  double cosine, sine;  // of twice the angle from the neighbour's chart to the point's
};

Vec2 direction(const Vec3& along, const ChartAxes& p) {
  return Vec2(along.dot(p.axis), along.dot(p.normal.cross(p.axis))).normalized();
}

TurnedEdge edge_between(const TensorPoint& a, const TensorPoint& b, double weight) {
  if (!(weight > 0) || !(b.area > 0)) return {0, 1, 0};
  using At = Eigen::Map<const Vec3>;
  const Vec2 turn =
      turn_between({At(a.normal), At(a.axis)}, {At(b.normal), At(b.axis)}, At(b.x) - At(a.x));
  if (!turn.allFinite()) return {0, 1, 0};
  return {weight, turn.x(), turn.y()};
}

// Reads the weights of point i of a run and writes its rows; returns the energy of half its edges.
template <class Neighbour>
double set_point(const RowRun<float>& run, std::size_t i, const TensorPoint& own,
                 Neighbour&& neighbour, double* force) {
  double energy = 0, sum = 0, moment[3] = {0, 0, 0};
  const double root = std::sqrt(own.area);
  for (int s = 1; s < run.slots; ++s) {
    const TensorPoint other = neighbour(s);
    const TurnedEdge edge =
        own.area > 0 ? edge_between(own, other, own.root * other.root * double(run.at(0, s, i)))
                     : TurnedEdge{0, 1, 0};
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

// z <- the rows of a run times y; the tensors of the neighbours are at y[s] + 3 i.
void apply_run(const RowRun<const float>& run, double damping, const double* const* y, double* z) {
  for (std::size_t i = 0; i < run.count; ++i) {
    const double* own = y[0] + 3 * i;
    const double diagonal = double(run.at(0, 0, i)) + damping;
    for (int c = 0; c < 3; ++c) z[3 * i + std::size_t(c)] = diagonal * own[c];
  }
  for (int s = 1; s < run.slots; ++s) {
    const float *weight = &run.at(0, s, 0), *cosine = &run.at(1, s, 0), *sine = &run.at(2, s, 0);
    const double* from = y[s];
    for (std::size_t i = 0; i < run.count; ++i) {
      const double* o = from + 3 * i;
      z[3 * i] += double(weight[i]) * o[0];
      z[3 * i + 1] += double(cosine[i]) * o[1] - double(sine[i]) * o[2];
      z[3 * i + 2] += double(sine[i]) * o[1] + double(cosine[i]) * o[2];
    }
  }
}

// A thread's copy of the points and their rings.
struct SurfaceGather {
  SurfaceGather(const GridLevel& grid, const Connection::Surface& surface, const double* tensor)
      : x(grid, surface.x, buffer[0]),
        normal(grid, surface.normal, buffer[1]),
        axis(grid, surface.axis, buffer[2]),
        tensors(grid, tensor, buffer[3]),
        area(grid, surface.area, buffer[4]),
        root(grid, surface.root, buffer[5]) {}
  SurfaceGather(const SurfaceGather&) = delete;

  std::vector<double> buffer[6];
  RunGather<double, 3> x, normal, axis, tensors;
  RunGather<double> area, root;
};

}  // namespace

// The edge's directions at its two ends differ by half a turn, which does not change twice the angle.
Vec2 turn_between(const ChartAxes& to, const ChartAxes& from, const Vec3& along) {
  const Vec2 p = direction(along, to), q = direction(along, from);
  const double c = p.dot(q), s = q.x() * p.y() - q.y() * p.x();
  return {c * c - s * s, 2 * c * s};
}

Connection::Connection(RingRows cotangents, const Surface& surface, const double* tensor,
                       Workers& workers, double* force)
    : rows_(std::move(cotangents)) {
  const GridLevel& grid = rows_.grid();
  ElementSums energy(grid.mesh());
  for_each_run(
      grid, workers, [&] { return SurfaceGather(grid, surface, tensor); },
      [&](const Run& run, SurfaceGather& gather) {
        const double *const *x = gather.x(run), *const *normal = gather.normal(run),
                            *const *axis = gather.axis(run), *const *m = gather.tensors(run),
                            *const *area = gather.area(run),
                            *const *root = surface.root ? gather.root(run) : nullptr;
        const RowRun<float> rows = rows_.of(run);
        for (std::size_t i = 0; i < run.count; ++i) {
          const auto point = [&](int s) -> TensorPoint {
            return {x[s] + 3 * i, normal[s] + 3 * i, axis[s] + 3 * i,
                    m[s] + 3 * i, area[s][i],        root ? root[s][i] : 1.0};
          };
          energy.of(run) += set_point(rows, i, point(0), point, force + 3 * (run.first + i));
        }
      });
  energy_ = energy.total();
}

void Connection::apply(double damping, Workers& workers, const double* y, double* z) const {
  for_each_run(
      rows_.grid(), workers, [&] { return RunGather<double, 3>(rows_.grid(), y); },
      [&](const Run& run, RunGather<double, 3>& gather) {
        apply_run(rows_.of(run), damping, gather(run), z + 3 * run.first);
      });
}

void Connection::apply_to_scalar(Workers& workers, const float* y, float* z) const {
  for_each_run(
      rows_.grid(), workers, [&] { return RunGather<float>(rows_.grid(), y); },
      [&](const Run& run, RunGather<float>& gather) {
        const RowRun<const float> own = rows_.of(run);
        const float* const* x = gather(run);
        float* to = z + run.first;
        for (std::size_t i = 0; i < run.count; ++i) to[i] = own.at(0, 0, i) * x[0][i];
        for (int s = 1; s < own.slots; ++s)
          for (std::size_t i = 0; i < run.count; ++i) to[i] += own.at(0, s, i) * x[s][i];
      });
}

}  // namespace fairing
