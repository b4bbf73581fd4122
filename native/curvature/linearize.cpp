// SPDX-License-Identifier: GPL-3.0-or-later
// CurvatureLevel::linearize(): energy, force and rows of all points about a surface.
#include <cmath>
#include <optional>
#include <utility>

#include "curvature/held_sides.h"
#include "curvature/level.h"
#include "curvature/rings.h"
#include "parallel/reductions.h"
#include "stencil/weights.h"

namespace fairing {
// The connection's input at the points, in double: rounding errors must not exceed the small force.
struct PointTensors {
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

// The values at points that are computed beside rows and force.
class PointValues {
 public:
  // `tensors`: for the connection; null: none. `wanted`: whether any values are.
  PointValues(Linearization& to, std::size_t points, bool wanted, bool with_axes,
              PointTensors* tensors)
      : to_(to), wanted_(wanted), with_axes_(with_axes), tensors_(tensors) {
    if (!wanted) return;
    to.normal.resize(3 * points);
    to.shape.resize(4 * points);
    if (with_axes) to.axis.resize(3 * points);
    if (tensors) tensors->resize(points);
  }

  bool need_axes() const { return with_axes_ || tensors_; }

  void put(std::size_t p, const Vec3& normal, const Vec3& shape, double root,
           const Vec3& axis) const {
    if (!wanted_) return;
    for (std::size_t a = 0; a < 3; ++a) {
      to_.normal[3 * p + a] = normal[a];
      to_.shape[4 * p + a] = float(shape[a]);
      if (with_axes_) to_.axis[3 * p + a] = float(axis[a]);
    }
    to_.shape[4 * p + 3] = float(root);
    if (tensors_) tensors_->put(p, shape, axis, root);
  }

  void clear(std::size_t p, std::size_t count) const {
    if (!wanted_) return;
    std::fill_n(to_.normal.data() + 3 * p, 3 * count, 0.0);
    std::fill_n(to_.shape.data() + 4 * p, 4 * count, 0.0f);
    if (with_axes_) std::fill_n(to_.axis.data() + 3 * p, 3 * count, 0.0f);
    if (tensors_) tensors_->clear(p, count);
  }

 private:
  Linearization& to_;
  bool wanted_, with_axes_;
  PointTensors* tensors_;
};

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
               const HeldSide* held, const RowRun<float>& run, std::size_t i,
               double* const* force) {
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
    if (held) rows.shape -= held->share * held->shape;
    const double area = weight * rows.point.area / (held ? 1 - held->share : 1);
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

// Linearizes the points of one run.
struct RunLinearizer {
  const Run& run;
  CurvatureEnergy energy;
  const EnergyWeight& factor;
  const HeldSide* held;  // of the run's vertex; null: none
  const PointValues& values;
  RowRun<float> rows, cotangents;  // the latter without slots unless there is a connection
  double* const* force;
  PointScratch& point;

  // One point; returns its energy.
  double alone(std::size_t i, const RingInSpace& ring, bool closed) const {
    const double out =
        point.store(ring, closed, energy, factor.point(run, i), held, rows, i, force);
    const Vec3& normal = point.rows.point.normal;
    const Vec3 axis =
        values.need_axes() ? chart_axis(normal, point.rows.chart) : Vec3(Vec3::Zero());
    values.put(run.first + i, normal, point.rows.shape, point.root, axis);
    if (cotangents.slots > 0) point.store_cotangents(ring, cotangents, i);
    return out;
  }

  // All points in lanes, and those alone that the lanes leave out; returns the run's energy.
  double in_lanes(const RunRings& rings) const {
    const auto weight = [&](std::size_t i) { return factor.point(run, i); };
    double out = 0;
    for (std::size_t i = 0; i < run.count; i += lane_count) {
      const std::size_t count = std::min<std::size_t>(lane_count, run.count - i);
      linearize(rings, i, energy, values.need_axes(), point.lanes);
      out += point.store_lanes(count, weight, rows, i, force);
      for (std::size_t l = 0; l < count; ++l) {
        if (point.lanes.done[l]) {
          put_lane(i, l);
          continue;
        }
        ring_at(rings, i + l, point.ring);
        out += alone(i + l, point.ring, true);
      }
    }
    return out;
  }

 private:
  void put_lane(std::size_t i, std::size_t l) const {
    const CurvatureLanes& lanes = point.lanes;
    const auto at = [&](const auto& v) { return Vec3(v[0][l], v[1][l], v[2][l]); };
    values.put(run.first + i + l, at(lanes.normal), at(lanes.shape), point.lane_root[l],
               values.need_axes() ? at(lanes.axis) : Vec3(Vec3::Zero()));
    for (int s = 0; s < cotangents.slots; ++s)
      cotangents.at(0, s, i + l) = float(lanes.cotangent[s][l]);
  }
};

// A thread's data of one surface, reused from run to run.
struct Gather {
  PointScratch& point;
  RingWalk walk;
  RingLanes lanes;
};

}  // namespace

double CurvatureLevel::linearize(const double* x, const Functional& functional,
                                 Linearization* out) {
  energy_ = functional.energy;
  in_cycles_ = functional.in_cycles;
  share_ = 0;
  const Unknowns& force_rows = functional.pads ? functional.pads->rows() : shared_.unknowns;
  Linearization own;
  Linearization& to = out ? *out : own;
  to.force.resize(grid_.size());
  PointTensors tensors;
  const PointValues values(to, grid_.size(), out || varies(), functional.with_axes,
                           varies() ? &tensors : nullptr);
  std::optional<RingRows> cotangents = room_for_cotangents();
  ++linearizations_;
  matrix_.reset();
  bending_ =
      linearize_points(x, force_rows, values, cotangents ? &*cotangents : nullptr, to.force.data());
  const double* const normal = to.normal.empty() ? nullptr : to.normal.data();
  if (varies()) {
    const double variation = connect(std::move(*cotangents), x, tensors, normal, to.force.data());
    if (std::isfinite(bending_)) bending_ = variation;
  }
  tension_ = add_tension(x, normal, force_rows, to.force.data());
  if (varies()) find_between(tensors.area);
  penalty_energy_ = penalty_ ? penalty_->energy(x, varies(), shared_.workers) : 0.0;
  if (penalty_ && normal)
    penalty_->add_force(x, normal, varies(), shared_.workers, to.force.data());
  update_diagonal();
  damping_.clear();
  invert_diagonal();
  return objective();
}

// The cotangents' rows for a new connection, in the storage of the one before.
std::optional<RingRows> CurvatureLevel::room_for_cotangents() {
  if (!varies()) return std::nullopt;
  if (!variation_) variation_ = std::make_unique<Variation>();
  auto& before = variation_->connection;
  return before ? std::move(*before).release() : RingRows(grid_);
}

// Rows, force, values and cotangents (null: none) of all points. Returns their total curvature.
double CurvatureLevel::linearize_points(const double* x, const Unknowns& force_rows,
                                        const PointValues& values, RingRows* cotangents,
                                        double* force) {
  const ControlMesh& mesh = shared_.mesh;
  const EnergyWeight factor(grid_);
  const Array<float> lifts = area_lifts(grid_, shared_.workers, x);
  const float* lift = lifts.empty() ? nullptr : lifts.data();
  std::vector<HeldSide> sides;
  if (!varies() && !shared_.refined && mesh.region.whole())
    sides = held_sides(grid_, shared_.unknowns, x);
  if (!mesh.region.whole())  // points outside are not visited
    shared_.workers.for_parts(
        grid_.size(), vector_grain / 8,
        [&](std::size_t begin, std::size_t end) { values.clear(begin, end - begin); });
  ElementSums energy(mesh);
  const auto body = [&](const Run& run, double* const* to, Gather& gather) {
    if (!has_fit(mesh, run)) return values.clear(run.first, run.count);
    const RunLinearizer pass{run,
                             energy_,
                             factor,
                             sides.empty() ? nullptr : &sides[run.element],
                             values,
                             rows_.of(run),
                             cotangents ? cotangents->of(run) : RowRun<float>{},
                             to,
                             gather.point};
    const bool is_regular = run.kind == RunKind::face_row ||
                            (run.kind == RunKind::edge && !mesh.edges[run.element].boundary());
    if (is_regular) {
      energy.of(run) += pass.in_lanes(gather.lanes(run));
      return;
    }
    gather.walk(run, [&](std::size_t i, const RingInSpace& ring, bool closed) {
      energy.of(run) += pass.alone(i, ring, closed);
    });
  };
  accumulate_runs(
      grid_, shared_.workers, shared_.double_slots, &force_rows, force,
      [&] { return Gather{point_scratch(), RingWalk(grid_, x, lift), RingLanes(grid_, x, lift)}; },
      body);
  return energy.total();
}

// Adds the force of tension, and by `normal` (null: not) K's part; returns the energy.
double CurvatureLevel::add_tension(const double* x, const double* normal,
                                   const Unknowns& force_rows, double* force) {
  if (!(shared_.tension > 0)) return 0;
  if (!area_) area_ = std::make_unique<AreaTerm>(grid_);
  return area_->linearize(shared_.tension, x, normal, force_rows, shared_.workers, force);
}

void CurvatureLevel::penalize(Reference reference, const double* x, Linearization& about) {
  penalty_.emplace(grid_, std::move(reference), about.shape, shared_.unknowns,
                   shared_.ends_in_variation);
  penalty_energy_ = penalty_->energy(x, false, shared_.workers);
  penalty_->add_force(x, about.normal.data(), false, shared_.workers, about.force.data());
  invert_diagonal();
}

// Computes L about the surface and the force, minus J^T L M. Returns the energy M . L M.
double CurvatureLevel::connect(RingRows cotangents, const double* x, const PointTensors& tensors,
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
