// SPDX-License-Identifier: GPL-3.0-or-later
#include "binding/solver.h"

#include <memory>

#include "binding/arrays.h"
#include "binding/report.h"
#include "binding/runner.h"
#include "fair/fair_solver.h"

namespace py = pybind11;

namespace fairing {
namespace {

// A solver and the thread that it lives on: there its buffers stay warm.
class KeptSolver {
 public:
  KeptSolver(const Contiguous<double>& vertices, Contiguous<std::int64_t> corners,
             Contiguous<std::int64_t> offsets, const FairOptions& options)
      : corners_(std::move(corners)), offsets_(std::move(offsets)) {
    const PolygonMesh mesh = mesh_of(vertices);
    call([&] { solver_ = std::make_unique<FairSolver>(mesh, options, monitor_); });
  }
  ~KeptSolver() {
    runner_.run_quietly([&] { solver_.reset(); });
  }

  // Arrays that are the same for all surfaces; read-only.
  py::dict constants() {
    OutputFaces faces;
    Array<std::int32_t> creases;
    call([&] {
      faces = solver_->faces();
      creases = solver_->creases();
    });
    py::dict d;
    d["triangles"] = to_numpy(std::move(faces.triangles), 3);
    d["quads"] = to_numpy(std::move(faces.quads), 4);
    d["triangle_polygon"] = to_numpy(std::move(faces.triangle_polygon), 1);
    d["quad_polygon"] = to_numpy(std::move(faces.quad_polygon), 1);
    d["crease_edges"] = to_numpy(std::move(creases), 2);
    for (const auto& entry : d) entry.second.attr("setflags")(py::arg("write") = false);
    return d;
  }

  py::dict solve(const Contiguous<double>& vertices, Monitor* watcher, const py::object& progress) {
    py::array_t<double> out({py::ssize_t(points_), py::ssize_t(3)});
    double* const to = out.mutable_data();
    const std::span<const double> coordinates = as_span(vertices);
    Report report;
    call([&] { report = solver_->solve(coordinates, to); }, watcher, progress);
    py::dict d;
    d["vertices"] = out;
    d["report"] = to_python(report);
    return d;
  }

  void rebase(const Contiguous<double>& vertices) {
    const PolygonMesh mesh = mesh_of(vertices);
    call([&] { solver_->rebase(mesh); });
  }

  std::size_t bytes() const { return bytes_; }

 private:
  PolygonMesh mesh_of(const Contiguous<double>& vertices) const {
    return {as_span(vertices), as_span(corners_), as_span(offsets_)};
  }
  template <class Job>
  void call(Job&& job, Monitor* watcher = nullptr, const py::object& progress = py::none()) {
    std::destroy_at(&monitor_);
    std::construct_at(&monitor_);
    runner_.run(
        [&] {
          job();
          points_ = solver_->points();
          bytes_ = solver_->bytes();
        },
        monitor_, watcher, progress);
  }

  Contiguous<std::int64_t> corners_, offsets_;
  Monitor monitor_;
  std::size_t points_ = 0, bytes_ = 0;
  Runner runner_;
  std::unique_ptr<FairSolver> solver_;
};

}  // namespace

void bind_solver(py::module_& m) {
  py::class_<KeptSolver>(m, "Solver")
      .def(py::init<const Contiguous<double>&, Contiguous<std::int64_t>, Contiguous<std::int64_t>,
                    const FairOptions&>(),
           py::arg("vertices").noconvert(), py::arg("corners").noconvert(), py::arg("offsets").noconvert(),
           py::arg("options"))
      .def("constants", &KeptSolver::constants)
      .def("solve", &KeptSolver::solve, py::arg("vertices").noconvert(), py::arg("monitor").none(true),
           py::arg("progress"))
      .def("rebase", &KeptSolver::rebase, py::arg("vertices").noconvert())
      .def_property_readonly("bytes", &KeptSolver::bytes);
}

}  // namespace fairing
