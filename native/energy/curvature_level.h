// SPDX-License-Identifier: GPL-3.0-or-later
// The Gauss-Newton system of a curvature energy on one level, about one surface: for scalar displacements h along the
// normals,
//
//   total curvature     E = sum_i w_i |M_i|^2                       K = J^T W J
//   minimum variation   E = sum_ij c_ij |M_i - T_ij M_j T_ij^T|^2   K = J^T (L + damping W) J
//
// where M_i is the second fundamental form (point_curvature.h), w_i its point's area, J its change with h, c_ij the
// cotangent weight of the edge ij, T_ij the rotation from one chart to the other, and L the connection Laplacian.
#pragma once

#include <memory>
#include <type_traits>
#include <utility>

#include "energy/connection.h"
#include "energy/ring_rows.h"
#include "energy/shape_rows.h"
#include "energy/sparse_square.h"
#include "energy/thin_plate.h"
#include "solver/level_operator.h"

namespace fairing {

// What all levels share.
struct CurvatureShared {
  const ControlMesh& mesh;
  Unknowns unknowns;
  CurvatureEnergy energy;
  Workers& workers;
  VertexWeights weights{};  // w |p - target|^2 is added to the energy; empty: none
  std::vector<Vec3> targets{};
  double damping = 0;  // minimum variation: of W beside L
  Exchange<double, 1> fine_exchange{};
  Exchange<float, 1> fast_exchange{};
  std::pair<Array<double>, Array<double>> fine_moments{};
  std::pair<Array<float>, Array<float>> fast_moments{};

  template <class T>
  auto& moments() {
    if constexpr (std::is_same_v<T, float>)
      return fast_moments;
    else
      return fine_moments;
  }
};

class CurvatureLevel final : public LevelOperator {
 public:
  CurvatureLevel(CurvatureShared& shared, const Lattice& lattice);

  // What a surface gives besides K, where asked for; all are resized. Zero where a point has no fit.
  struct Surface {
    Array<double> force;     // minus half the energy's gradient, on the unknowns: K h = force is the step
    Array<double> normal;    // 3 a point
    Array<float> shape;      // 4 a point: M's orthonormal components, and the root of the area
    bool with_axes = false;  // asked for:
    Array<float> axis;       // 3 a point, the chart's u axis in space
  };
  // K about the surface x (3 numbers a point). Returns the energy, the weights' part included.
  double linearize(const double* x, Surface* out = nullptr);

  // The latest energy without the weights' part.
  double bending() const { return bending_; }

  // Call after shared.damping has changed: nothing else of K depends on it but what apply() and assemble() look up.
  void update_diagonal();

  // M as it would be after the displacement h, to first order: 3 numbers a point.
  void predict(const Array<float>& shape, const double* h, Array<float>& predicted);

  // mu_i K_ii is added to the diagonal from here on; empty: nothing.
  void set_damping(const Array<float>& mu);

  const Array<float>& diagonal() const { return diagonal_; }  // zero where a point is no unknown

  std::size_t points() const override { return lattice_.size(); }
  std::size_t components() const override { return 1; }
  void apply(const double* x, double* y) override { apply_any(x, y, shared_.fine_exchange); }
  void apply(const float* x, float* y) override { apply_any(x, y, shared_.fast_exchange); }
  bool does_with_single() const override { return lattice_.n() <= most_of_single; }
  const Array<float>& inverse_diagonal() const override { return inverse_diagonal_; }
  AssembledSystem assemble() const override;

 private:
  struct Tensors;
  double connect(const double* x, const Tensors& tensors, const double* normal, double* force);
  template <class T>
  void apply_any(const T* x, T* y, Exchange<T, 1>& exchange);
  void apply_rows(const double* x, double* y);
  void apply_rows(const float* x, float* y);
  bool varies() const { return shared_.energy == CurvatureEnergy::minimum_variation; }

  CurvatureShared& shared_;
  const Lattice& lattice_;
  double bending_ = 0;
  RingRows rows_;                              // sqrt(w) J
  std::unique_ptr<SparseSquare> square_;       // of the rows, once it has been wanted
  std::vector<std::uint8_t> square_vertices_;  // that were unknowns then
  bool suits_square_, square_is_old_ = true;
  std::vector<double> vertex_weight_;       // of the control vertices' weights, along their normals
  std::unique_ptr<Connection> connection_;  // minimum variation only
  Array<float> diagonal_, inverse_diagonal_, damping_;
};

}  // namespace fairing
