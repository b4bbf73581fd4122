// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/spectrum.h"

#include <Eigen/Eigenvalues>
#include <cmath>

#include "execution/vectors.h"

namespace fairing {
namespace {
constexpr int steps = 10;
constexpr double margin = 1.1;  // Lanczos comes from below
}  // namespace

double largest_eigenvalue(LevelOperator& op, Workers& workers, const float* start) {
  const std::size_t components = op.components(), size = op.size();
  const Array<float>& inverse = op.inverse_diagonal();
  Array<float> roots(size);
  workers.for_parts(op.points(), vector_grain / 4, [&](std::size_t begin, std::size_t end) {
    for (std::size_t p = begin; p < end; ++p)
      std::fill_n(roots.data() + components * p, components, float(std::sqrt(double(inverse[p]))));
  });
  const auto root = [&](std::size_t i) { return double(roots[i]); };
  // Lanczos for D^-1/2 K D^-1/2: v are its vectors, `scaled` is what K is applied to.
  Array<float> v(size), before(size), scaled(size + vector_room), image(size);
  const double length = std::sqrt(sum(workers, size, [&](std::size_t i) {
    const double s = double(start[i]) * root(i);
    return s * s;
  }));
  if (!(length > 0) || !std::isfinite(length)) return 4.0;  // nothing to solve; any safe value
  for_each_index(workers, size, [&](std::size_t i) {
    v[i] = float(double(start[i]) * root(i) / length);
    before[i] = 0;
  });
  Eigen::VectorXd diagonal(steps), off(steps);
  int m = 0;
  double beta = 0;
  for (; m < steps; ++m) {
    for_each_index(workers, size, [&](std::size_t i) { scaled[i] = float(v[i] * root(i)); });
    op.apply(scaled.data(), image.data());
    for_each_index(workers, size,
                   [&](std::size_t i) { image[i] = float(image[i] * root(i) - beta * before[i]); });
    const double alpha = sum(workers, size, [&](std::size_t i) { return double(image[i]) * v[i]; });
    diagonal(m) = alpha;
    for_each_index(workers, size, [&](std::size_t i) { image[i] = float(image[i] - alpha * v[i]); });
    beta = norm(workers, size, image.data());
    off(m) = beta;
    if (!(beta > 1e-5 * alpha)) {
      ++m;
      break;
    }
    std::swap(before, v);
    for_each_index(workers, size, [&](std::size_t i) { v[i] = float(image[i] / beta); });
  }
  Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen;
  eigen.computeFromTridiagonal(diagonal.head(m), off.head(m > 1 ? m - 1 : 0), Eigen::EigenvaluesOnly);
  return margin * eigen.eigenvalues().maxCoeff();
}

}  // namespace fairing
