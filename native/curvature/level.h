// SPDX-License-Identifier: GPL-3.0-or-later
// The Gauss-Newton system of a curvature energy on one level, about one surface: for scalar
// displacements h along the normals,
//
//   total curvature     E = sum_i w_i |M_i|^2                       K = J^T W J
//   minimum variation   E = sum_ij c_ij |M_i - T_ij M_j T_ij^T|^2   K = J^T (L + share W) J
//
// where M_i is the second fundamental form (point_curvature.h), w_i the area of its point, J its
// derivative by h, c_ij the cotangent weight of the edge ij, T_ij the rotation from one chart to
// the other, and L the connection Laplacian. Tension adds the surface's area to either (area.h).
#pragma once

#include <memory>
#include <optional>

#include "constraints/pads.h"
#include "curvature/area.h"
#include "curvature/connection.h"
#include "curvature/distance_penalty.h"
#include "curvature/point_curvature.h"
#include "multigrid/level_operator.h"
#include "sparse/ring_matrix.h"
#include "sparse/ring_rows.h"
#include "stencil/weights.h"

namespace fairing {

// Data that all levels share.
struct CurvatureShared {
  const ControlMesh& mesh;
  Unknowns unknowns;
  Workers& workers;
  double tension = 0;              // tension times area is added to the energy
  bool ends_in_variation = false;  // the finest level minimizes it
  bool refined = false;            // faces have points of their own
  ElementSlots<double, 1> double_slots{};
  ElementSlots<float, 1> float_slots{};
  Array<double> moment{}, turned{};  // for minimum variation
};

// The functional to linearize.
struct Functional {
  CurvatureEnergy energy = CurvatureEnergy::total_curvature;
  // Pads of control vertices, for which the force is computed too; null: for the unknowns only.
  const Pads* pads = nullptr;
  bool with_axes = false;  // whether to compute the charts' axes
  // Total curvature as the A of apply_between(): the penalty is minimum variation's, in its share.
  bool in_cycles = false;

  bool operator==(const Functional&) const = default;
};

// The results of linearizing about a surface, apart from K. They are zero at points without a fit.
struct Linearization {
  // Minus half the energy's gradient along the normals, on the unknowns and on control vertices on
  // pads. Without pads K h = force gives the step.
  Array<double> force;
  Array<double> normal;  // 3 a point, of unit length
  Array<float> shape;    // 4 a point: M's orthonormal components, and the root of its area
  Array<float> axis;     // 3 a point: the chart's u axis in space
};

struct PointTensors;
class PointValues;

class CurvatureLevel final : public LevelOperator {
 public:
  // Pieces of an edge up to which a matrix is faster than passes: twice as fast with few.
  static constexpr int most_pieces = 16;

  CurvatureLevel(CurvatureShared& shared, const GridLevel& grid);

  // K about the surface x (3 numbers a point), without a share of total curvature. Returns the
  // energy with those of tension and the penalty.
  double linearize(const double* x, const Functional& functional, Linearization* out = nullptr);

  // The latest energy, by which surfaces are compared.
  double objective() const { return bending_ + tension_ + penalty_energy_; }

  int linearizations() const { return linearizations_; }

  // For minimum variation apply() and inverse_diagonal() in single precision are those of J^T W J,
  // and this is the S between two cycles with them (LinearSystem::between): y <- S x. The cotangent
  // Laplacian C is of second order, and J^T W J C^-1 J^T W J of sixth, along thin faces too. Next
  // to a border J^T W J has surfaces without a moment that K does not have; there S has a spring of
  // about n, since waves of moments there are at most a control edge long.
  void apply_between(const float* x, float* y);
  bool varies() const { return energy_ == CurvatureEnergy::minimum_variation; }

  // predicted <- M after the displacement h, to first order: 3 numbers a point.
  void predict(const Array<float>& shape, const double* h, Array<float>& predicted);

  // Adds mu_i K_ii to the diagonal; empty: nothing. For minimum variation, adds `share` of W to L.
  void set_damping(const Array<float>& mu, double share = 0);
  // Call it when coarser levels are linearized about another surface: eigenvalues change.
  void spectrum_changed() { ++version_.spectrum; }
  // Call it when other control vertices become unknowns; then linearize again.
  void unknowns_changed() { ++version_.unknowns; }
  // Weights of springs at control vertices along the normals; empty: none.
  void set_weights(const VertexWeights& weights);
  const VertexWeights& weights() const { return weights_; }

  // Penalizes the distance from a reference from here on, by weights from the bending of the surface
  // x, whose linearization for total curvature is the latest; adds the penalty's part to that.
  void penalize(Reference reference, const double* x, Linearization& about);
  const std::optional<DistancePenalty>& penalty() const { return penalty_; }

  // Diagonal of K without weights, penalty and damping; zero for points that are not unknowns.
  const Array<float>& diagonal() const { return diagonal_; }

  std::size_t points() const override { return grid_.size(); }
  std::size_t components() const override { return 1; }
  void apply(const double* x, double* y) override;
  void apply(const float* x, float* y) override;
  // y <- K x on `rows` without weights; x is zero off the unknowns. For total curvature only.
  void apply_on(const Unknowns& rows, const double* x, double* y);
  const Array<float>& inverse_diagonal() const override { return inverse_diagonal_; }
  AssembledSystem assemble() const override;
  void write_lines(LineBand& band, Workers& workers) override;

 private:
  double linearize_points(const double* x, const Unknowns& force_rows, const PointValues& values,
                          RingRows* cotangents, double* force);
  std::optional<RingRows> room_for_cotangents();
  double add_tension(const double* x, const double* normal, const Unknowns& force_rows,
                     double* force);
  double connect(RingRows cotangents, const double* x, const PointTensors& tensors,
                 const double* normal, double* force);
  void find_between(const Array<double>& area);
  void update_diagonal();
  void invert_diagonal();
  const RingMatrix<1>& matrix();
  void apply_rows(const double* x, double* y);
  void apply_rows(const float* x, float* y);
  // Adds the part of weights, penalty and damping.
  template <class T>
  void add_to_product(const T* x, T* y) const;
  template <class T>
  void add_diagonal(const T* x, T* y) const;  // of penalty and damping
  double weight(std::size_t v) const { return shared_.unknowns.vertex[v] ? weights_[v] : 0.0; }
  void invert_diagonal(std::size_t i);
  // Of penalty and damping.
  double added_to_diagonal(std::size_t p) const {
    return penalty_at(p, in_cycles_) + (damping_.empty() ? 0.0 : double(damping_[p]));
  }
  double penalty_at(std::size_t p, bool in_cycles) const {
    if (!penalty_) return 0;
    return in_cycles ? penalty_->in_cycles(p) : penalty_->weight(p, varies());
  }
  bool is_tense() const { return area_ && shared_.tension > 0; }

  CurvatureShared& shared_;
  const GridLevel& grid_;
  CurvatureEnergy energy_ = CurvatureEnergy::total_curvature;
  bool in_cycles_ = false;
  VertexWeights weights_;
  double share_ = 0;  // for minimum variation: the share of W beside L
  double bending_ = 0, tension_ = 0, penalty_energy_ = 0;
  int linearizations_ = 0;
  RingRows rows_;  // sqrt(w) J
  const bool has_matrix_;
  std::optional<RingMatrix<1>> matrix_;  // R^T R and tension, of the present rows on first use
  struct Variation {
    std::optional<Connection> connection;
    Array<float> root;               // of points' areas
    Array<float> beside_cotangents;  // diagonal of S - C
    Array<float> cycle_diagonal;     // of J^T W J
  };
  std::unique_ptr<Variation> variation_;  // for minimum variation, once linearized
  std::unique_ptr<AreaTerm> area_;        // with tension, once linearized
  std::optional<DistancePenalty> penalty_;
  Array<float> diagonal_, inverse_diagonal_, damping_;
};

}  // namespace fairing
