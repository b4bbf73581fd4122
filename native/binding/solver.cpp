// SPDX-License-Identifier: GPL-3.0-or-later
#include <memory>

#include "binding/arrays.h"
#include "binding/bindings.h"
#include "binding/construct.h"
#include "binding/report.h"
#include "binding/runner.h"
#include "fairing/fair.h"

namespace py = pybind11;

namespace fairing {
namespace {

// A FairSolver with the thread for all its calls.
class Solver {
 public:
  Solver(const Numbers& vertices, const Ids& corners, const Ids& offsets,
         const FairOptions& options)
      : corners_(copy_of(corners)), offsets_(copy_of(offsets)) {
    if (!runner_.has_thread())
      throw FairingError(ErrorCode::no_thread,
                         {"A thread could not be started, and a solver needs one.",
                          "End other programs, or use fair(), which works without."});
    const std::vector<double> coordinates = copy_of(vertices);
    call([&] { solver_ = std::make_unique<FairSolver>(mesh_of(coordinates), options, monitor_); });
  }
  ~Solver() {
    if (runner_.is_left_behind())
      static_cast<void>(solver_.release());  // its threads do not exist here and cannot be joined
    else
      runner_.run_quietly([&] { solver_.reset(); });
  }

  // The faces, the same for all surfaces; read-only arrays.
  py::dict constants() {
    OutputFaces faces;
    Array<std::int32_t> creases;
    call([&] {
      faces = solver_->faces();
      creases = solver_->creases();
    });
    py::dict d;
    add_faces(d, std::move(faces), std::move(creases));
    for (const auto& entry : d) entry.second.attr("setflags")(py::arg("write") = false);
    d["mended"] = to_python(solver_->mended());
    return d;
  }

  py::dict solve(const Numbers& vertices, Monitor* watcher, const py::object& progress) {
    py::array_t<double> out({py::ssize_t(points_), py::ssize_t(3)});
    double* const to = out.mutable_data();
    const std::vector<double> coordinates = copy_of(vertices);
    Report report;
    call([&] { report = solver_->solve(coordinates, to); }, watcher, progress);
    py::dict d;
    d["vertices"] = out;
    d["report"] = to_python(report);
    return d;
  }

  void rebase(const Numbers& vertices) {
    const std::vector<double> coordinates = copy_of(vertices);
    call([&] { solver_->rebase(mesh_of(coordinates)); });
  }

  std::size_t bytes() const { return bytes_; }
  void require_own_process() const { runner_.require_own_process(); }

 private:
  PolygonMesh mesh_of(const std::vector<double>& coordinates) const {
    return {coordinates, corners_, offsets_};
  }
  // A monitor serves one call: its progress never falls, and it stays cancelled.
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

  std::vector<std::int64_t> corners_, offsets_;
  Monitor monitor_;
  std::size_t points_ = 0, bytes_ = 0;
  Runner runner_;
  std::unique_ptr<FairSolver> solver_;
};

}  // namespace

void bind_solver(py::module_& m) {
  py::class_<Solver> solver(m, "Solver", "discrete_fairing.Solver on plain arrays.");
  define_constructor<const Numbers&, const Ids&, const Ids&, const FairOptions&>(
      solver, exact("vertices"), exact("corners"), exact("offsets"), py::arg("options"));
  solver.def("constants", &Solver::constants)
      .def("solve", &Solver::solve, exact("vertices"), py::arg("monitor").none(true),
           py::arg("progress"))
      .def("require_own_process", &Solver::require_own_process)
      .def("rebase", &Solver::rebase, exact("vertices"))
      .def_property_readonly("bytes", &Solver::bytes);
}

}  // namespace fairing
