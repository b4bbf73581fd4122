// SPDX-License-Identifier: GPL-3.0-or-later
// CurvatureLevel::linearize(): energy, force and rows of all points about a surface.
#include <cmath>
#include <optional>
#include <utility>

#include "curvature/level.h"
#include "curvature/rings.h"
#include "parallel/reductions.h"
#include "stencil/weights.h"

namespace fairing {
namespace {

// A thread's buffers; they do not depend on the surface.
struct PointScratch {
  ShapeRows rows;
  CurvatureLanes lanes;
  RingInSpace ring;
  double lane_root[lane_count];  // roots of the lanes' areas, times the weight of the energy
  double root = 0;               // the same for `rows`

  // Stores the rows of point i of a run; returns its energy and adds its part of the force.
  double store(const RingInSpace& at, bool closed, CurvatureEnergy energy, double weight,
               const RowRun<float>& run, std::size_t i, double* const* force) {
    linearize(at.view(closed), energy, rows);
    if (!rows.point.has_rows()) {
      const double out = rows.point.area;  // infinite, or zero
      for (int c = 0; c < 3; ++c)
        for (int s = 0; s < run.slots; ++s) run.at(c, s, i) = 0;
      rows.point.area = 0;
      rows.point.normal.setZero();
      rows.shape.setZero();
      root = 0;
      return out;
    }
    const double area = weight * rows.point.area;
    root = std::sqrt(area);
    const auto put = [&](int slot, const Vec3& row) {
      for (int c = 0; c < 3; ++c) run.at(c, slot, i) = float(root * row[c]);
      force[slot][i] += -area * row.dot(rows.shape);
    };
    put(0, rows.own);
    for (std::size_t j = 0; j < rows.row.size(); ++j) put(at.slot()[j], rows.row[j]);
    return area * rows.shape.squaredNorm();
  }

  // Stores the rows of points i … i + count - 1 of a run from the lanes, except the points that the
  // lanes leave out; returns their energy.
  template <class Weight>
  double store_lanes(std::size_t count, Weight&& weight, const RowRun<float>& run, std::size_t i,
                     double* const* force) {
    double area[lane_count], energy = 0;
    for (std::size_t l = 0; l < count; ++l) {
      area[l] = weight(i + l) * lanes.area[l];
      lane_root[l] = std::sqrt(area[l]);
      for (const auto& m : lanes.shape) energy += area[l] * m[l] * m[l];
    }
    for (int s = 0; s < run.slots; ++s) {
      const auto& row = lanes.row[s];
      for (int c = 0; c < 3; ++c)
        for (std::size_t l = 0; l < count; ++l)
          run.at(c, s, i + l) = float(lane_root[l] * row[c][l]);
      double* to = force[s] + i;
      for (std::size_t l = 0; l < count; ++l)
        to[l] -= area[l] * (row[0][l] * lanes.shape[0][l] + row[1][l] * lanes.shape[1][l] +
                            row[2][l] * lanes.shape[2][l]);
    }
    return energy;
  }

  // Stores the cotangents of point i's edges for the connection.
  void store_cotangents(const RingInSpace& at, const RowRun<float>& run, std::size_t i) const {
    for (int s = 0; s < run.slots; ++s) run.at(0, s, i) = 0;
    if (!(rows.point.area > 0)) return;
    for (std::size_t j = 0; j < at.slot().size(); ++j)
      run.at(0, at.slot()[j], i) = float(rows.chart.cotangent[j]);
  }
};

PointScratch& point_scratch() {
  thread_local PointScratch own;
  return own;
}

// A thread's data of one surface, reused from run to run.
struct Gather {
  PointScratch& point;
  RingWalk walk;
  RingLanes lanes;
};

}  // namespace

// The connection's input at the points, in double: rounding errors must not exceed the small force.
struct CurvatureLevel::Tensors {
  Array<double> shape, axis, area;

  void resize(std::size_t points) {
    shape.resize(3 * points);
    axis.resize(3 * points);
    area.resize(points);
  }
  void put(std::size_t p, const Vec3& m, const Vec3& u, double root) {
    for (std::size_t a = 0; a < 3; ++a) {
      shape[3 * p + a] = m[a];
      axis[3 * p + a] = u[a];
    }
    area[p] = root * root;
  }
  void clear(std::size_t p, std::size_t count) {
    std::fill_n(shape.data() + 3 * p, 3 * count, 0.0);
    std::fill_n(axis.data() + 3 * p, 3 * count, 0.0);
    std::fill_n(area.data() + p, count, 0.0);
  }
};

double CurvatureLevel::linearize(const double* x, const Functional& functional,
                                 Linearization* out) {
  energy_ = functional.energy;
  in_cycles_ = functional.in_cycles;
  share_ = 0;
  const ControlMesh& mesh = shared_.mesh;
  const Unknowns& force_rows = functional.pads ? functional.pads->rows() : shared_.unknowns;
  const EnergyWeight factor(grid_);
  const Array<float> lifts = area_lifts(grid_, shared_.workers, x);
  const float* lift = lifts.empty() ? nullptr : lifts.data();
  Tensors tensors;
  std::optional<RingRows> edge_weights;
  if (varies()) {
    if (!variation_) variation_ = std::make_unique<Variation>();
    auto& before = variation_->connection;
    edge_weights.emplace(before ? std::move(*before).release() : RingRows(grid_));
    tensors.resize(grid_.size());
  }
  ElementSums energy(mesh);
  Linearization own;
  Linearization& to = out ? *out : own;
  to.force.resize(grid_.size());
  const bool wants_points = out || varies(), wants_axis = functional.with_axes || varies();
  if (wants_points) {
    to.normal.resize(3 * grid_.size());
    to.shape.resize(4 * grid_.size());
    if (functional.with_axes) to.axis.resize(3 * grid_.size());
  }
  const auto put_point = [&](std::size_t p, const Vec3& normal, const Vec3& shape, double root,
                             const Vec3& axis) {
    if (!wants_points) return;
    for (std::size_t a = 0; a < 3; ++a) {
      to.normal[3 * p + a] = normal[a];
      to.shape[4 * p + a] = float(shape[a]);
      if (functional.with_axes) to.axis[3 * p + a] = float(axis[a]);
    }
    to.shape[4 * p + 3] = float(root);
    if (varies()) tensors.put(p, shape, axis, root);
  };
  const auto clear_points = [&](std::size_t p, std::size_t count) {
    if (!wants_points) return;
    std::fill_n(to.normal.data() + 3 * p, 3 * count, 0.0);
    std::fill_n(to.shape.data() + 4 * p, 4 * count, 0.0f);
    if (functional.with_axes) std::fill_n(to.axis.data() + 3 * p, 3 * count, 0.0f);
    if (varies()) tensors.clear(p, count);
  };
  if (!mesh.region.whole())  // points outside are not visited
    shared_.workers.for_parts(
        grid_.size(), vector_grain / 8,
        [&](std::size_t begin, std::size_t end) { clear_points(begin, end - begin); });

  ++linearizations_;
  square_.is_old = true;
  const auto body = [&](const Run& run, double* const* force, Gather& gather) {
    if (!has_fit(mesh, run)) return clear_points(run.first, run.count);
    PointScratch& point = gather.point;
    const RowRun<float> rows = rows_.of(run);
    const RowRun<float> cotangents = edge_weights ? edge_weights->of(run) : RowRun<float>{};
    const auto weight = [&](std::size_t i) { return factor.point(run, i); };
    const auto store_alone = [&](std::size_t i, const RingInSpace& ring, bool closed) {
      const double e = point.store(ring, closed, energy_, weight(i), rows, i, force);
      const Vec3& normal = point.rows.point.normal;
      const Vec3 axis = wants_axis ? chart_axis(normal, point.rows.chart) : Vec3(Vec3::Zero());
      put_point(run.first + i, normal, point.rows.shape, point.root, axis);
      if (varies()) point.store_cotangents(ring, cotangents, i);
      return e;
    };
    const bool is_regular = run.kind == RunKind::face_row ||
                            (run.kind == RunKind::edge && !mesh.edges[run.element].boundary());
    if (!is_regular) {
      gather.walk(run, [&](std::size_t i, const RingInSpace& ring, bool closed) {
        energy.of(run) += store_alone(i, ring, closed);
      });
      return;
    }
    const RunRings& rings = gather.lanes(run);
    const CurvatureLanes& lanes = point.lanes;
    double of_run = 0;
    for (std::size_t i = 0; i < run.count; i += lane_count) {
      const std::size_t count = std::min<std::size_t>(lane_count, run.count - i);
      fairing::linearize(rings, i, energy_, wants_axis, point.lanes);
      of_run += point.store_lanes(count, weight, rows, i, force);
      for (std::size_t l = 0; l < count; ++l) {
        if (!lanes.done[l]) {
          ring_at(rings, i + l, point.ring);
          of_run += store_alone(i + l, point.ring, true);
          continue;
        }
        const auto at = [&](const auto& v) { return Vec3(v[0][l], v[1][l], v[2][l]); };
        put_point(run.first + i + l, at(lanes.normal), at(lanes.shape), point.lane_root[l],
                  wants_axis ? at(lanes.axis) : Vec3(Vec3::Zero()));
        for (int s = 0; s < cotangents.slots; ++s)
          cotangents.at(0, s, i + l) = float(lanes.cotangent[s][l]);
      }
    }
    energy.of(run) += of_run;
  };
  accumulate_runs(
      grid_, shared_.workers, shared_.double_slots, &force_rows, to.force.data(),
      [&] { return Gather{point_scratch(), RingWalk(grid_, x, lift), RingLanes(grid_, x, lift)}; },
      body);

  bending_ = energy.total();
  if (varies()) {
    const double variation =
        connect(std::move(*edge_weights), x, tensors, to.normal.data(), to.force.data());
    if (std::isfinite(bending_)) bending_ = variation;
  }
  if (shared_.tension > 0) {
    if (!area_) area_ = std::make_unique<AreaTerm>(grid_);
    tension_ = area_->linearize(shared_.tension, x, wants_points ? to.normal.data() : nullptr,
                                force_rows, shared_.workers, to.force.data());
  } else {
    tension_ = 0;
  }
  if (varies()) find_between(tensors.area);
  penalty_energy_ = penalty_ ? penalty_->energy(x, varies(), shared_.workers) : 0.0;
  if (penalty_ && wants_points)
    penalty_->add_force(x, to.normal.data(), varies(), shared_.workers, to.force.data());
  update_diagonal();
  damping_.clear();
  invert_diagonal();
  return objective();
}

void CurvatureLevel::penalize(Reference reference, const double* x, Linearization& about) {
  penalty_.emplace(grid_, std::move(reference), about.shape, shared_.unknowns,
                   shared_.ends_in_variation);
  penalty_energy_ = penalty_->energy(x, false, shared_.workers);
  penalty_->add_force(x, about.normal.data(), false, shared_.workers, about.force.data());
  invert_diagonal();
}

// Computes L about the surface and the force, minus J^T L M. Returns the energy M . L M.
double CurvatureLevel::connect(RingRows cotangents, const double* x, const Tensors& tensors,
                               const double* normal, double* force) {
  const std::size_t points = grid_.size();
  Array<double> moment(3 * points);
  const Array<double> root = stiffness_roots(grid_);
  const Connection::Surface surface{x, normal, tensors.axis.data(), tensors.area.data(),
                                    root.empty() ? nullptr : root.data()};
  variation_->connection.emplace(std::move(cotangents), surface, tensors.shape.data(),
                                 shared_.workers, moment.data());
  for_each_index(shared_.workers, 3 * points, [&](std::size_t i) { moment[i] = -moment[i]; });
  apply_transposed(rows_, shared_.unknowns, shared_.workers, shared_.double_slots, moment.data(),
                   force);
  return variation_->connection->energy();
}

}  // namespace fairing
