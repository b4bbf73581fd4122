// SPDX-License-Identifier: GPL-3.0-or-later
#include "energy/curvature_level.h"

#include <cmath>

#include "energy/assemble.h"
#include "energy/joint_weight.h"
#include "energy/surface_walk.h"
#include "execution/vectors.h"

namespace fairing {
namespace {

// One element's part of a linearization.
struct Linearizer {
  ShapeRows rows;
  WalkScratch scratch;

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
      return 0;
    }
    const double area = weight * rows.point.area, root = std::sqrt(area);
    const auto put = [&](int slot, const Vec3& row) {
      for (int c = 0; c < 3; ++c) run.at(c, slot, i) = float(root * row[c]);
      give(slot, -area * row.dot(rows.shape));
    };
    put(0, rows.own);
    for (std::size_t j = 0; j < rows.row.size(); ++j) put(at.slot()[j], rows.row[j]);
    return area * rows.shape.squaredNorm();
  }
};

// One a thread.
Linearizer& linearizer() {
  thread_local Linearizer own;
  return own;
}

}  // namespace

CurvatureLevel::CurvatureLevel(CurvatureShared& shared, const Lattice& lattice)
    : shared_(shared), lattice_(lattice), rows_(lattice) {
  if (varies()) connection_ = std::make_unique<Connection>(lattice);
}

double CurvatureLevel::linearize(const double* x, Surface* out) {
  const ControlMesh& mesh = shared_.mesh;
  const int n = lattice_.n();
  const JointWeight joint(lattice_);
  const CurvatureEnergy kind = shared_.energy;
  const Array<float> lifts = area_lifts(lattice_, shared_.workers, x);
  const float* lift = lifts.empty() ? nullptr : lifts.data();
  std::vector<double> vertex_energy(std::size_t(mesh.vertex_count()), 0.0),
      edge_energy(mesh.edges.size(), 0.0), face_energy(mesh.faces.size(), 0.0);
  Surface own;
  Surface& surface = out ? *out : own;
  surface.force.resize(lattice_.size());
  if (out) {
    surface.normal.resize(3 * lattice_.size());
    surface.shape.resize(4 * lattice_.size());
  }
  const auto put_point = [&](std::size_t p, const Linearizer& l) {
    if (!out) return;
    for (std::size_t a = 0; a < 3; ++a) {
      surface.normal[3 * p + a] = l.rows.point.normal[Eigen::Index(a)];
      surface.shape[4 * p + a] = float(l.rows.shape[Eigen::Index(a)]);
    }
    surface.shape[4 * p + 3] = float(std::sqrt(l.rows.point.area));
  };
  const auto clear_points = [&](std::size_t p, std::size_t count) {
    if (!out) return;
    std::fill_n(surface.normal.data() + 3 * p, 3 * count, 0.0);
    std::fill_n(surface.shape.data() + 4 * p, 4 * count, 0.0f);
  };

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
      put_point(std::size_t(v), l);
    });
  };
  const auto edge_body = [&](Index e, double* run, double* left, double* right, std::vector<double>&) {
    clear_lanes<1>(n, run, left, right);
    const std::size_t first = std::size_t(lattice_.edge_base(e));
    if (n > 1) clear_points(first, std::size_t(n - 1));
    if (n == 1 || !mesh.edge_fit(e)) return;
    double* const lanes[3] = {run, left, right};
    const Beside<double> target = beside_edge(EdgeRingLanes(mesh, e), lanes);
    const RowRun<float> rows = rows_.edge(e);
    Linearizer& l = linearizer();
    walk_edge(lattice_, e, x, lift, l.scratch, [&](std::size_t i, const RingInSpace& ring, bool closed) {
      edge_energy[std::size_t(e)] += l.store(ring, closed, kind, joint.edge_point(e, int(i) + 1), rows, i,
                                             [&](int slot, double f) { target.at[slot][i] += f; });
      put_point(first + i, l);
    });
  };
  const auto face_body = [&](Index f, double* closed, std::vector<double>&) {
    const bool quad = mesh.faces[std::size_t(f)].quad();
    std::fill_n(closed, closed_size(quad, std::size_t(n)), 0.0);
    std::size_t p = std::size_t(lattice_.face_base(f));
    Linearizer& l = linearizer();
    walk_face(lattice_, f, x, lift, l.scratch,
              [&](int j, std::size_t i, const RingInSpace& ring, bool whole) {
                const Beside<double> target = beside_row(quad, n, j, closed);
                face_energy[std::size_t(f)] +=
                    l.store(ring, whole, kind, joint.face_point(f, int(i) + 1, j), rows_.face(f, j), i,
                            [&](int slot, double g) { target.at[slot][i] += g; });
                put_point(p++, l);
              });
  };
  accumulate(lattice_, shared_.workers, shared_.fine_exchange, &shared_.unknowns, surface.force.data(),
             vertex_body, edge_body, face_body);

  double total = 0;
  for (const auto& part : {vertex_energy, edge_energy, face_energy})
    for (const double e : part) total += e;
  vertex_weight_.assign(shared_.weights.size(), 0.0);
  for (std::size_t v = 0; v < shared_.weights.size(); ++v) {
    const double weight = shared_.weights[v];
    if (!shared_.unknowns.vertex[v] || !(weight > 0)) continue;
    const Vec3 away = Vec3(x[3 * v], x[3 * v + 1], x[3 * v + 2]) - shared_.targets[v];
    total += weight * away.squaredNorm();
    vertex_weight_[v] = weight;
    if (out)
      surface.force[v] -= weight * (surface.normal[3 * v] * away[0] + surface.normal[3 * v + 1] * away[1] +
                                    surface.normal[3 * v + 2] * away[2]);
  }
  update_diagonal();
  return total;
}

template <class T>
void CurvatureLevel::apply_any(const T* x, T* y, Exchange<T, 1>& exchange) {
  const ControlMesh& mesh = shared_.mesh;
  const int n = lattice_.n();
  const auto vertex_body = [&](Index v, T* centre, T* spokes, std::vector<T>&) {
    if (!vertex_weight_.empty()) *centre += T(vertex_weight_[std::size_t(v)]) * x[v];
    if (!mesh.vertex_fit(v)) return;
    const RowRun<const float> run = std::as_const(rows_).vertex(v);
    T moment[3];
    for (int c = 0; c < 3; ++c) moment[c] = T(run.at(c, 0, 0)) * x[v];
    int slot = 0;
    visit_ring(lattice_, v, [&](Index p, std::size_t) {
      ++slot;
      for (int c = 0; c < 3; ++c) moment[c] += T(run.at(c, slot, 0)) * x[p];
    });
    const auto back = [&](int s) {
      return T(run.at(0, s, 0)) * moment[0] + T(run.at(1, s, 0)) * moment[1] + T(run.at(2, s, 0)) * moment[2];
    };
    *centre += back(0);
    slot = 0;
    visit_ring(lattice_, v, [&](Index, std::size_t place) { spokes[place] += back(++slot); });
  };
  const auto edge_body = [&](Index e, T* run, T* left, T* right, std::vector<T>& scratch) {
    clear_lanes<1>(n, run, left, right);
    if (n == 1 || !mesh.edge_fit(e)) return;
    const std::size_t stride = lane_stride<1>(n) + lane_block;
    if (scratch.size() < 6 * stride) scratch.resize(6 * stride);
    const EdgeRingLanes ring(mesh, e);
    const EdgeLanes<T, 1> lanes(lattice_, x, e, scratch);
    T* const target[3] = {run, left, right};
    T* moments = scratch.data() + 3 * stride;
    const RowRun<const float> rows = std::as_const(rows_).edge(e);
    forward<T>(rows, beside_edge<T>(ring, lanes.lane).at, moments);
    backward<T>(rows, moments, beside_edge(ring, target).at);
  };
  const auto face_body = [&](Index f, T* closed, std::vector<T>& scratch) {
    const bool quad = mesh.faces[std::size_t(f)].quad();
    const std::size_t size = closed_size(quad, std::size_t(n));
    std::fill_n(closed, size, T(0));
    if (n < (quad ? 2 : 3)) return;
    if (scratch.size() < size + 3 * std::size_t(n)) scratch.resize(size + 3 * std::size_t(n));
    gather_face<1>(lattice_, x, f, scratch.data());
    T* moments = scratch.data() + size;
    for (int j = 1; j < n; ++j) {
      const RowRun<const float> rows = std::as_const(rows_).face(f, j);
      if (rows.count == 0) break;
      forward<T>(rows, beside_row(quad, n, j, scratch.data()).at, moments);
      backward<T>(rows, moments, beside_row(quad, n, j, closed).at);
    }
  };
  accumulate(lattice_, shared_.workers, exchange, &shared_.unknowns, y, vertex_body, edge_body, face_body);
  if (!damping_.empty())
    for_each_index(shared_.workers, damping_.size(), [&](std::size_t i) { y[i] += T(damping_[i]) * x[i]; });
}

void CurvatureLevel::predict(const Array<float>& shape, const double* h, Array<float>& predicted) {
  const ControlMesh& mesh = shared_.mesh;
  const int n = lattice_.n();
  predicted.resize(3 * lattice_.size());
  // `moment` is sqrt(w) J h
  const auto put = [&](std::size_t p, std::size_t count, const double* moment) {
    for (std::size_t i = 0; i < count; ++i) {
      const float* m = shape.data() + 4 * (p + i);
      for (std::size_t c = 0; c < 3; ++c)
        predicted[3 * (p + i) + c] = m[3] > 0 ? m[c] + float(moment[c * count + i] / double(m[3])) : 0.0f;
    }
  };
  shared_.workers.for_parts(std::size_t(mesh.vertex_count()), 256, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) {
      const RowRun<const float> run = std::as_const(rows_).vertex(Index(v));
      double moment[3] = {0, 0, 0};
      if (mesh.vertex_fit(Index(v))) {
        for (int c = 0; c < 3; ++c) moment[c] = double(run.at(c, 0, 0)) * h[v];
        int slot = 0;
        visit_ring(lattice_, Index(v), [&](Index p, std::size_t) {
          ++slot;
          for (int c = 0; c < 3; ++c) moment[c] += double(run.at(c, slot, 0)) * h[p];
        });
      }
      put(v, 1, moment);
    }
  });
  shared_.workers.for_parts(n > 1 ? mesh.edges.size() : 0, 64, [&](std::size_t begin, std::size_t end) {
    std::vector<double> scratch, moment(3 * std::size_t(n));
    for (Index e = Index(begin); e < Index(end); ++e) {
      const RowRun<const float> run = std::as_const(rows_).edge(e);
      const EdgeLanes<double, 1> lanes(lattice_, h, e, scratch);
      forward<double>(run, beside_edge<double>(EdgeRingLanes(mesh, e), lanes.lane).at, moment.data());
      put(std::size_t(lattice_.edge_base(e)), run.count, moment.data());
    }
  });
  shared_.workers.for_parts(mesh.faces.size(), element_grain(n), [&](std::size_t begin, std::size_t end) {
    std::vector<double> closed(closed_size(true, std::size_t(n))), moment(3 * std::size_t(n));
    for (Index f = Index(begin); f < Index(end); ++f) {
      const bool quad = mesh.faces[std::size_t(f)].quad();
      gather_face<1>(lattice_, h, f, closed.data());
      std::size_t p = std::size_t(lattice_.face_base(f));
      for (int j = 1; j < n; ++j) {
        const RowRun<const float> run = std::as_const(rows_).face(f, j);
        forward<double>(run, beside_row(quad, n, j, closed.data()).at, moment.data());
        put(p, run.count, moment.data());
        p += run.count;
      }
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

void CurvatureLevel::update_diagonal() {
  const ControlMesh& mesh = shared_.mesh;
  const int n = lattice_.n();
  const auto square = [](const RowRun<const float>& run, int s, std::size_t i) {
    double sum = 0;
    for (int c = 0; c < 3; ++c) sum += double(run.at(c, s, i)) * double(run.at(c, s, i));
    return float(sum);
  };
  const auto vertex_body = [&](Index v, float* centre, float* spokes, std::vector<float>&) {
    if (!vertex_weight_.empty()) *centre += float(vertex_weight_[std::size_t(v)]);
    if (!mesh.vertex_fit(v)) return;
    const RowRun<const float> run = std::as_const(rows_).vertex(v);
    *centre += square(run, 0, 0);
    int slot = 0;
    visit_ring(lattice_, v, [&](Index, std::size_t place) { spokes[place] += square(run, ++slot, 0); });
  };
  const auto edge_body = [&](Index e, float* run, float* left, float* right, std::vector<float>&) {
    clear_lanes<1>(n, run, left, right);
    if (n == 1 || !mesh.edge_fit(e)) return;
    const RowRun<const float> rows = std::as_const(rows_).edge(e);
    float* const lanes[3] = {run, left, right};
    const Beside<float> target = beside_edge(EdgeRingLanes(mesh, e), lanes);
    for (int s = 0; s < rows.slots; ++s)
      for (std::size_t i = 0; i < rows.count; ++i) target.at[s][i] += square(rows, s, i);
  };
  const auto face_body = [&](Index f, float* closed, std::vector<float>&) {
    const bool quad = mesh.faces[std::size_t(f)].quad();
    std::fill_n(closed, closed_size(quad, std::size_t(n)), 0.0f);
    for (int j = 1; j < n; ++j) {
      const RowRun<const float> rows = std::as_const(rows_).face(f, j);
      const Beside<float> target = beside_row(quad, n, j, closed);
      for (int s = 0; s < rows.slots; ++s)
        for (std::size_t i = 0; i < rows.count; ++i) target.at[s][i] += square(rows, s, i);
    }
  };
  diagonal_.resize(lattice_.size());
  accumulate(lattice_, shared_.workers, shared_.fast_exchange, &shared_.unknowns, diagonal_.data(),
             vertex_body, edge_body, face_body);
  set_damping({});
}

AssembledSystem CurvatureLevel::assemble() const {
  const ControlMesh& mesh = shared_.mesh;
  const int n = lattice_.n();
  AssembledSystem system;
  const std::vector<Index> number = number_unknowns(lattice_, shared_.unknowns);
  for (std::size_t p = 0; p < number.size(); ++p)
    if (number[p] >= 0) system.unknown_points.push_back(Index(p));
  std::vector<Eigen::Triplet<double>> entries;
  Eigen::Index row = 0;
  const auto add = [&](Index p, const RowRun<const float>& run, int s, std::size_t i) {
    const Index column = number[std::size_t(p)];
    if (column < 0) return;
    for (int c = 0; c < 3; ++c) entries.emplace_back(row + c, column, double(run.at(c, s, i)));
  };
  for (Index v = 0; v < mesh.vertex_count(); ++v) {
    if (!mesh.vertex_fit(v)) continue;
    const RowRun<const float> run = rows_.vertex(v);
    add(v, run, 0, 0);
    int slot = 0;
    visit_ring(lattice_, v, [&](Index p, std::size_t) { add(p, run, ++slot, 0); });
    row += 3;
  }
  for (std::size_t e = 0; e < mesh.edges.size() && n > 1; ++e) {
    if (!mesh.edge_fit(Index(e))) continue;
    const RowRun<const float> run = rows_.edge(Index(e));
    const EdgeRingLanes ring(mesh, Index(e));
    const auto lane_point = [&](int lane, int k) {
      if (lane == 0) return lattice_.edge_point(Index(e), k);
      const Side& side = mesh.sides[std::size_t(mesh.edges[e].side[std::size_t(lane - 1)])];
      const bool quad = mesh.faces[std::size_t(side.face)].quad();
      const int along = side.reversed ? row_size(quad, n) - 1 - k : k;
      return lattice_.face_point(side.face, closed_point(quad, n, side.local, along, 1));
    };
    for (int k = 1; k < n; ++k) {
      add(lattice_.edge_point(Index(e), k), run, 0, std::size_t(k - 1));
      for (int j = 0; j < ring.size; ++j)
        add(lane_point(ring.lane[j], ring.at[j] + k), run, j + 1, std::size_t(k - 1));
      row += 3;
    }
  }
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    if (mesh.face_place(Index(f)) != Place::inside) continue;
    const bool quad = mesh.faces[f].quad();
    for (int j = 1; j < n; ++j) {
      const RowRun<const float> run = rows_.face(Index(f), j);
      for (std::size_t i = 0; i < run.count; ++i) {
        add(lattice_.face_point(Index(f), int(i) + 1, j), run, 0, i);
        int slot = 0;
        for (const LatticePoint d : face_ring(quad))
          add(lattice_.face_point(Index(f), int(i) + 1 + d.i, j + d.j), run, ++slot, i);
        row += 3;
      }
    }
  }
  const auto size = Eigen::Index(system.unknown_points.size());
  SparseMatrix jacobian(row, size);
  jacobian.setFromTriplets(entries.begin(), entries.end());
  system.matrix = SparseMatrix(jacobian.transpose()) * jacobian;
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
