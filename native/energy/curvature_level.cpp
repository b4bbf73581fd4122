// SPDX-License-Identifier: GPL-3.0-or-later
#include "energy/curvature_level.h"

#include <cmath>

#include "energy/assemble.h"
#include "energy/joint_weight.h"
#include "energy/ring_passes.h"
#include "energy/run_rings.h"
#include "execution/vectors.h"

namespace fairing {
namespace {

// One element's part of a linearization.
struct Linearizer {
  ShapeRows rows;
  WalkScratch scratch;
  ShapePack pack;
  RunScratch runs;
  double root = 0;  // of the area, with what else weighs the energy

  // The rows of point i of a run; returns its energy. `give(slot, force)` is called for the point's part of the force.
  template <class Give>
  double store(const RingInSpace& at, bool closed, CurvatureEnergy energy, double weight,
               const RowRun<float>& run, std::size_t i, Give&& give) {
    linearize(at.view(closed), energy, rows);
    if (!(rows.point.area > 0)) {
      for (int c = 0; c < 3; ++c)
        for (int s = 0; s < run.slots; ++s) run.at(c, s, i) = 0;
      rows.point.area = 0;
      rows.point.normal.setZero();
      rows.shape.setZero();
      root = 0;
      return 0;
    }
    const double area = weight * rows.point.area;
    root = std::sqrt(area);
    const auto put = [&](int slot, const Vec3& row) {
      for (int c = 0; c < 3; ++c) run.at(c, slot, i) = float(root * row[c]);
      give(slot, -area * row.dot(rows.shape));
    };
    put(0, rows.own);
    for (std::size_t j = 0; j < rows.row.size(); ++j) put(at.slot()[j], rows.row[j]);
    return area * rows.shape.squaredNorm();
  }

  // The rows of points i … i + count - 1 of a run from the pack, as far as it has them; returns their energy.
  template <class Weight>
  double store_pack(std::size_t count, Weight&& weight, const RowRun<float>& run, std::size_t i,
                    const Beside<double>& force) {
    double area[pack_points], energy = 0;
    for (std::size_t l = 0; l < count; ++l) {
      area[l] = weight(i + l) * pack.area[l];
      pack_root[l] = std::sqrt(area[l]);
      for (const auto& m : pack.shape) energy += area[l] * m[l] * m[l];
    }
    for (int s = 0; s < run.slots; ++s) {
      const auto& row = pack.row[s];
      for (int c = 0; c < 3; ++c)
        for (std::size_t l = 0; l < count; ++l) run.at(c, s, i + l) = float(pack_root[l] * row[c][l]);
      double* to = force.at[s] + i;
      for (std::size_t l = 0; l < count; ++l)
        to[l] -= area[l] *
                 (row[0][l] * pack.shape[0][l] + row[1][l] * pack.shape[1][l] + row[2][l] * pack.shape[2][l]);
    }
    return energy;
  }
  double pack_root[pack_points];

  // The cotangents of point i's edges, for the connection.
  void store_weights(const RingInSpace& at, const RowRun<float>& run, std::size_t i) const {
    for (int s = 0; s < run.slots; ++s) run.at(0, s, i) = 0;
    if (!(rows.point.area > 0)) return;
    for (std::size_t j = 0; j < at.slot().size(); ++j)
      run.at(0, at.slot()[j], i) = float(rows.chart.cotangent[j]);
  }
};

// One a thread.
Linearizer& linearizer() {
  thread_local Linearizer own;
  return own;
}

}  // namespace

// What the connection needs of the points, in double: at its minimum nothing but rounding is left of the force.
struct CurvatureLevel::Tensors {
  Array<double> shape, axis, area;

  void resize(std::size_t points) {
    shape.resize(3 * points);
    axis.resize(3 * points);
    area.resize(points);
  }
  void put(std::size_t p, const Vec3& m, const Vec3& u, double root) {
    for (std::size_t a = 0; a < 3; ++a) {
      shape[3 * p + a] = m[Eigen::Index(a)];
      axis[3 * p + a] = u[Eigen::Index(a)];
    }
    area[p] = root * root;
  }
  void clear(std::size_t p, std::size_t count) {
    std::fill_n(shape.data() + 3 * p, 3 * count, 0.0);
    std::fill_n(axis.data() + 3 * p, 3 * count, 0.0);
    std::fill_n(area.data() + p, count, 0.0);
  }
};

CurvatureLevel::CurvatureLevel(CurvatureShared& shared, const Lattice& lattice)
    : shared_(shared), lattice_(lattice), rows_(lattice), suits_square_(SparseSquare::suits(rows_)) {}

double CurvatureLevel::linearize(const double* x, Surface* out) {
  const ControlMesh& mesh = shared_.mesh;
  const int n = lattice_.n();
  const JointWeight joint(lattice_);
  const CurvatureEnergy kind = shared_.energy;
  const Array<float> lifts = area_lifts(lattice_, shared_.workers, x);
  const float* lift = lifts.empty() ? nullptr : lifts.data();
  if (varies() && !connection_) connection_ = std::make_unique<Connection>(lattice_);
  Tensors tensors;
  if (varies()) tensors.resize(lattice_.size());
  std::vector<double> vertex_energy(std::size_t(mesh.vertex_count()), 0.0),
      edge_energy(mesh.edges.size(), 0.0), face_energy(mesh.faces.size(), 0.0);
  Surface own;
  Surface& surface = out ? *out : own;
  surface.force.resize(lattice_.size());
  const bool wants_points = out || varies();
  if (wants_points) {
    surface.normal.resize(3 * lattice_.size());
    surface.shape.resize(4 * lattice_.size());
    if (surface.with_axes) surface.axis.resize(3 * lattice_.size());
  }
  const auto put_point = [&](std::size_t p, const Vec3& normal, const Vec3& shape, double root,
                             const Vec3& axis) {
    if (!wants_points) return;
    for (std::size_t a = 0; a < 3; ++a) {
      surface.normal[3 * p + a] = normal[Eigen::Index(a)];
      surface.shape[4 * p + a] = float(shape[Eigen::Index(a)]);
      if (surface.with_axes) surface.axis[3 * p + a] = float(axis[Eigen::Index(a)]);
    }
    surface.shape[4 * p + 3] = float(root);
    if (varies()) tensors.put(p, shape, axis, root);
  };
  const bool wants_axis = surface.with_axes || varies();
  const auto put_single = [&](std::size_t p, const Linearizer& l, const RingInSpace& ring) {
    const PointCurvature& point = l.rows.point;
    put_point(p, point.normal, l.rows.shape, l.root,
              wants_axis ? chart_axis(point.normal, ring.view(true).offset, l.rows.chart) : Vec3::Zero());
  };
  const auto put_lane = [&](std::size_t p, const Linearizer& l, std::size_t lane) {
    const auto at = [&](const auto& v) { return Vec3(v[0][lane], v[1][lane], v[2][lane]); };
    put_point(p, at(l.pack.normal), at(l.pack.shape), l.pack_root[lane],
              wants_axis ? at(l.pack.axis) : Vec3::Zero());
  };
  const auto clear_points = [&](std::size_t p, std::size_t count) {
    if (!wants_points) return;
    std::fill_n(surface.normal.data() + 3 * p, 3 * count, 0.0);
    std::fill_n(surface.shape.data() + 4 * p, 4 * count, 0.0f);
    if (surface.with_axes) std::fill_n(surface.axis.data() + 3 * p, 3 * count, 0.0f);
    if (varies()) tensors.clear(p, count);
  };
  if (!mesh.region.whole())  // faces outside are not visited
    shared_.workers.for_parts(lattice_.size(), vector_grain / 8,
                              [&](std::size_t begin, std::size_t end) { clear_points(begin, end - begin); });

  const auto vertex_body = [&](Index v, double* centre, double* spokes, std::vector<double>&) {
    clear_points(std::size_t(v), 1);
    if (!mesh.vertex_fit(v)) return;
    Linearizer& l = linearizer();
    walk_vertex(lattice_, v, x, lift, l.scratch, [&](const RingInSpace& ring, bool closed) {
      std::vector<std::size_t> place;
      visit_ring(lattice_, v, [&](Index, std::size_t slot) { place.push_back(slot); });
      vertex_energy[std::size_t(v)] = l.store(
          ring, closed, kind, joint.vertex(v), rows_.vertex(v), 0,
          [&](int slot, double f) { (slot == 0 ? *centre : spokes[place[std::size_t(slot - 1)]]) += f; });
      put_single(std::size_t(v), l, ring);
      if (varies()) l.store_weights(ring, connection_->weights().vertex(v), 0);
    });
  };
  // All points of a run from point p of the lattice on; returns their energy.
  const auto store_run = [&](Linearizer& l, const RunRings& rings, std::size_t p, auto&& weight,
                             const RowRun<float>& rows, const RowRun<float>& cotangents,
                             const Beside<double>& force) {
    double energy = 0;
    for (std::size_t i = 0; i < rows.count; i += pack_points) {
      const std::size_t count = std::min<std::size_t>(pack_points, rows.count - i);
      fairing::linearize(rings, i, kind, wants_axis, l.pack);
      energy += l.store_pack(count, weight, rows, i, force);
      for (std::size_t lane = 0; lane < count; ++lane) {
        if (l.pack.done[lane]) {
          put_lane(p + i + lane, l, lane);
          for (int s = 0; s < cotangents.slots; ++s)
            cotangents.at(0, s, i + lane) = float(l.pack.cotangent[s][lane]);
          continue;
        }
        RingInSpace& ring = l.scratch.ring;
        ring_at(rings, i + lane, ring);
        energy += l.store(ring, true, kind, weight(i + lane), rows, i + lane,
                          [&](int slot, double f) { force.at[slot][i + lane] += f; });
        put_single(p + i + lane, l, ring);
        if (varies()) l.store_weights(ring, cotangents, i + lane);
      }
    }
    return energy;
  };
  const auto edge_body = [&](Index e, double* run, double* left, double* right, std::vector<double>&) {
    clear_lanes<1>(n, run, left, right);
    const std::size_t first = std::size_t(lattice_.edge_base(e));
    if (n > 1) clear_points(first, std::size_t(n - 1));
    if (n == 1 || !mesh.edge_fit(e)) return;
    double* const lanes[3] = {run, left, right};
    const Beside<double> target = beside_edge(EdgeRingLanes(mesh, e), lanes);
    const RowRun<float> rows = rows_.edge(e);
    const RowRun<float> cotangents = varies() ? connection_->weights().edge(e) : RowRun<float>{};
    Linearizer& l = linearizer();
    const auto weight = [&](std::size_t i) { return joint.edge_point(e, int(i) + 1); };
    double& energy = edge_energy[std::size_t(e)];
    if (!mesh.edges[std::size_t(e)].boundary()) {
      energy =
          store_run(l, edge_rings(lattice_, e, x, lift, l.runs), first, weight, rows, cotangents, target);
      return;
    }
    walk_edge(lattice_, e, x, lift, l.scratch, [&](std::size_t i, const RingInSpace& ring, bool closed) {
      energy += l.store(ring, closed, kind, weight(i), rows, i,
                        [&](int slot, double f) { target.at[slot][i] += f; });
      put_single(first + i, l, ring);
      if (varies()) l.store_weights(ring, cotangents, i);
    });
  };
  const auto face_body = [&](Index f, double* closed, std::vector<double>&) {
    const bool quad = mesh.faces[std::size_t(f)].quad();
    std::fill_n(closed, closed_size(quad, std::size_t(n)), 0.0);
    std::size_t p = std::size_t(lattice_.face_base(f));
    Linearizer& l = linearizer();
    visit_face_runs(lattice_, f, x, lift, l.runs, [&](int j, const RunRings& rings) {
      const RowRun<float> rows = rows_.face(f, j);
      face_energy[std::size_t(f)] += store_run(
          l, rings, p, [&](std::size_t i) { return joint.face_point(f, int(i) + 1, j); }, rows,
          varies() ? connection_->weights().face(f, j) : RowRun<float>{}, beside_row(quad, n, j, closed));
      p += rows.count;
    });
  };
  square_is_old_ = true;
  accumulate(lattice_, shared_.workers, shared_.fine_exchange, &shared_.unknowns, surface.force.data(),
             vertex_body, edge_body, face_body);

  double total = 0;
  for (const auto& part : {vertex_energy, edge_energy, face_energy})
    for (const double e : part) total += e;
  if (varies()) total = connect(x, tensors, surface.normal.data(), surface.force.data());
  bending_ = total;
  vertex_weight_.assign(shared_.weights.size(), 0.0);
  for (std::size_t v = 0; v < shared_.weights.size(); ++v) {
    const double weight = shared_.weights[v];
    if (!shared_.unknowns.vertex[v] || !(weight > 0)) continue;
    const Vec3 away = Vec3(x[3 * v], x[3 * v + 1], x[3 * v + 2]) - shared_.targets[v];
    total += weight * away.squaredNorm();
    vertex_weight_[v] = weight;
    if (wants_points)
      surface.force[v] -= weight * (surface.normal[3 * v] * away[0] + surface.normal[3 * v + 1] * away[1] +
                                    surface.normal[3 * v + 2] * away[2]);
  }
  update_diagonal();
  return total;
}

// L about the surface, and with it the force: minus J^T L M. Returns the energy M . L M.
double CurvatureLevel::connect(const double* x, const Tensors& tensors, const double* normal, double* force) {
  const std::size_t points = lattice_.size();
  Array<double> moment(3 * points);
  const double energy = connection_->set({x, normal, tensors.axis.data(), tensors.area.data()},
                                         tensors.shape.data(), shared_.workers, moment.data());
  for_each_index(shared_.workers, 3 * points, [&](std::size_t i) { moment[i] = -moment[i]; });
  apply_transposed(rows_, shared_.unknowns, shared_.workers, shared_.fine_exchange, moment.data(), force);
  return energy;
}

void CurvatureLevel::apply_rows(const double* x, double* y) {
  apply_square(rows_, shared_.unknowns, shared_.workers, shared_.fine_exchange, x, y);
}

void CurvatureLevel::apply_rows(const float* x, float* y) {
  if (!suits_square_) {
    apply_square(rows_, shared_.unknowns, shared_.workers, shared_.fast_exchange, x, y);
    return;
  }
  if (std::exchange(square_is_old_, false)) {
    if (square_vertices_ != shared_.unknowns.vertex) square_.reset();  // some have been held, or let go
    if (!square_) square_ = std::make_unique<SparseSquare>(rows_, shared_.unknowns);
    square_vertices_ = shared_.unknowns.vertex;
    square_->update(rows_, shared_.workers);
  }
  square_->apply(x, shared_.workers, y);
}

template <class T>
void CurvatureLevel::apply_any(const T* x, T* y, Exchange<T, 1>& exchange) {
  if (varies()) {
    auto& [moment, turned] = shared_.moments<T>();
    if (moment.size() < 3 * lattice_.size()) {
      moment.resize(3 * lattice_.size());
      turned.resize(3 * lattice_.size());
    }
    visit_moments(rows_, shared_.workers, x, [&](std::size_t p, std::size_t count, const T* lanes) {
      for (std::size_t i = 0; i < count; ++i)
        for (std::size_t c = 0; c < 3; ++c) moment[3 * (p + i) + c] = lanes[c * count + i];
    });
    connection_->apply(shared_.damping, shared_.workers, moment.data(), turned.data());
    apply_transposed(rows_, shared_.unknowns, shared_.workers, exchange, turned.data(), y);
  } else {
    apply_rows(x, y);
  }
  for (std::size_t v = 0; v < vertex_weight_.size(); ++v) y[v] += T(vertex_weight_[v]) * x[v];
  if (!damping_.empty())
    for_each_index(shared_.workers, damping_.size(), [&](std::size_t i) { y[i] += T(damping_[i]) * x[i]; });
}

void CurvatureLevel::predict(const Array<float>& shape, const double* h, Array<float>& predicted) {
  predicted.resize(3 * lattice_.size());
  // the moments are sqrt(w) J h
  visit_moments(rows_, shared_.workers, h, [&](std::size_t p, std::size_t count, const double* moment) {
    for (std::size_t i = 0; i < count; ++i) {
      const float* m = shape.data() + 4 * (p + i);
      for (std::size_t c = 0; c < 3; ++c)
        predicted[3 * (p + i) + c] = m[3] > 0 ? m[c] + float(moment[c * count + i] / double(m[3])) : 0.0f;
    }
  });
}

void CurvatureLevel::set_damping(const Array<float>& mu) {
  damping_.clear();
  inverse_diagonal_.resize(lattice_.size());
  if (!mu.empty()) {
    damping_.resize(lattice_.size());
    for (std::size_t i = 0; i < damping_.size(); ++i) damping_[i] = mu[i] * diagonal_[i];
  }
  for (std::size_t i = 0; i < inverse_diagonal_.size(); ++i) {
    const float d = diagonal_[i] + (mu.empty() ? 0.0f : damping_[i]);
    inverse_diagonal_[i] = d > 0 ? 1 / d : 1.0f;
  }
}

// For the variation that of J^T diag(L + damping W) J, which is as good a scale as its own.
void CurvatureLevel::update_diagonal() {
  const std::size_t points = lattice_.size();
  Array<float> weight;
  if (varies()) {
    weight.resize(points);
    visit_rows(connection_->rows(), [&](Index p, const RowRun<const float>& run, std::size_t i, const auto&) {
      weight[std::size_t(p)] = run.at(0, 0, i) + float(shared_.damping);
    });
  }
  diagonal_.resize(points);
  square_diagonal(rows_, shared_.unknowns, shared_.workers, shared_.fast_exchange,
                  varies() ? weight.data() : nullptr, diagonal_.data());
  for (std::size_t v = 0; v < vertex_weight_.size(); ++v) diagonal_[v] += float(vertex_weight_[v]);
  set_damping({});
}

AssembledSystem CurvatureLevel::assemble() const {
  AssembledSystem system;
  const std::vector<Index> number = number_unknowns(lattice_, shared_.unknowns);
  for (std::size_t p = 0; p < number.size(); ++p)
    if (number[p] >= 0) system.unknown_points.push_back(Index(p));
  const auto size = Eigen::Index(system.unknown_points.size()), moments = Eigen::Index(3 * lattice_.size());
  std::vector<Eigen::Triplet<double>> entries;
  visit_rows(rows_,
             [&](Index p, const RowRun<const float>& run, std::size_t i, const std::vector<Index>& at) {
               for (int s = 0; s < run.slots; ++s) {
                 const Index column = number[std::size_t(at[std::size_t(s)])];
                 for (int c = 0; c < 3 && column >= 0; ++c)
                   entries.emplace_back(3 * p + c, column, double(run.at(c, s, i)));
               }
             });
  SparseMatrix jacobian(moments, size);
  jacobian.setFromTriplets(entries.begin(), entries.end());
  const SparseMatrix transposed = jacobian.transpose();
  if (varies()) {
    entries.clear();
    visit_rows(connection_->rows(),
               [&](Index p, const RowRun<const float>& run, std::size_t i, const std::vector<Index>& at) {
                 for (int c = 0; c < 3; ++c)
                   entries.emplace_back(3 * p + c, 3 * p + c, double(run.at(0, 0, i)) + shared_.damping);
                 for (int s = 1; s < run.slots; ++s) {
                   const Index q = at[std::size_t(s)];
                   const double cosine = run.at(1, s, i), sine = run.at(2, s, i);
                   entries.emplace_back(3 * p, 3 * q, double(run.at(0, s, i)));
                   entries.emplace_back(3 * p + 1, 3 * q + 1, cosine);
                   entries.emplace_back(3 * p + 1, 3 * q + 2, -sine);
                   entries.emplace_back(3 * p + 2, 3 * q + 1, sine);
                   entries.emplace_back(3 * p + 2, 3 * q + 2, cosine);
                 }
               });
    SparseMatrix connection(moments, moments);
    connection.setFromTriplets(entries.begin(), entries.end());
    const SparseMatrix turned = connection * jacobian;
    system.matrix = transposed * turned;
  } else {
    system.matrix = transposed * jacobian;
  }
  for (Eigen::Index i = 0; i < size; ++i) {
    const auto p = std::size_t(system.unknown_points[std::size_t(i)]);
    double extra = system.matrix.coeff(i, i) > 0 ? 0.0 : 1.0;
    if (p < vertex_weight_.size()) extra += vertex_weight_[p];
    if (!damping_.empty()) extra += double(damping_[p]);
    if (extra > 0) system.matrix.coeffRef(i, i) += extra;
  }
  return system;
}

}  // namespace fairing
