// SPDX-License-Identifier: GPL-3.0-or-later
// Functions for the package's joints/: surfaces at borders, and the angles by which they turn.
#include <pybind11/pybind11.h>

#include "binding/arrays.h"
#include "binding/bindings.h"
#include "sparse/least_squares.h"
#include "stencil/border_fit.h"

namespace py = pybind11;

namespace fairing {
namespace {

// For k vertices and e pairs of a vertex and a point near: (k, 15) normals, inward, second
// fundamental forms; and (e, 2) rows. `begin`: (k + 1,) into the pairs; `degree`: (k,).
py::tuple border_fits(const Numbers& points, const Ids& vertex, const Ids& begin, const Ids& near,
                      const Ids& degree, const Numbers& along, const Numbers& up, double soft,
                      double level, double full_rank) {
  const auto at = points.unchecked<2>(), axis = along.unchecked<2>(), top = up.unchecked<2>();
  const auto one = vertex.unchecked<1>(), first = begin.unchecked<1>(), other = near.unchecked<1>(),
             of = degree.unchecked<1>();
  const auto vec = [](const auto& a, std::int64_t i) { return Vec3(a(i, 0), a(i, 1), a(i, 2)); };
  Array<double> values(15 * std::size_t(vertex.size())), rows(2 * std::size_t(near.size()));
  {
    const py::gil_scoped_release release;
    std::vector<Vec3> away;
    for (py::ssize_t k = 0; k < vertex.size(); ++k) {
      away.clear();
      for (std::int64_t e = first(k); e < first(k + 1); ++e)
        away.push_back(vec(at, other(e)) - vec(at, one(k)));
      const BorderFit fit =
          fit_border(away, vec(axis, k), vec(top, k), {int(of(k)), soft, level, full_rank});
      double* const out = values.data() + 15 * k;
      Eigen::Map<Vec3>{out} = fit.normal;
      Eigen::Map<Vec3>{out + 3} = fit.inward;
      Eigen::Map<Eigen::Matrix3d>{out + 6} = fit.bend;
      Eigen::Map<Eigen::Matrix2Xd>(rows.data() + 2 * first(k), 2, fit.rows.rows()) =
          fit.rows.transpose();
    }
  }
  return py::make_tuple(to_numpy(std::move(values), 15), to_numpy(std::move(rows), 2));
}

// (columns,): see damped_solution(); entries of the matrix in one place add up.
py::array solved(const Ids& row, const Ids& column, const Numbers& value, std::size_t columns,
                 const Numbers& right, int steps, double share) {
  Array<double> out(columns);
  {
    const py::gil_scoped_release release;
    std::vector<Eigen::Triplet<double>> entries;
    entries.reserve(std::size_t(value.size()));
    for (py::ssize_t e = 0; e < value.size(); ++e)
      entries.emplace_back(int(row.data()[e]), int(column.data()[e]), value.data()[e]);
    Eigen::SparseMatrix<double, Eigen::RowMajor> matrix(right.size(), Eigen::Index(columns));
    matrix.setFromTriplets(entries.begin(), entries.end());
    Eigen::Map<Eigen::VectorXd>(out.data(), Eigen::Index(columns)) = damped_solution(
        matrix, Eigen::Map<const Eigen::VectorXd>(right.data(), right.size()), steps, share);
  }
  return to_numpy(std::move(out), 1);
}

}  // namespace

void bind_joints(py::module_& m) {
  m.def("border_fits", &border_fits, exact("points"), exact("vertex"), exact("begin"),
        exact("near"), exact("degree"), exact("along"), exact("up"), py::arg("soft"),
        py::arg("level"), py::arg("full_rank"), "Polynomials at border vertices.");
  m.def("damped_solution", &solved, exact("row"), exact("column"), exact("value"),
        py::arg("columns"), exact("right"), py::arg("steps"), py::arg("share"),
        "Least squares that end before insensitive components grow.");
}

}  // namespace fairing
