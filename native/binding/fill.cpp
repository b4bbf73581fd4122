// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/fill/fill.h"

#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <mutex>

#include "binding/arrays.h"
#include "binding/bindings.h"
#include "binding/construct.h"
#include "binding/report.h"
#include "binding/runner.h"
#include "mesh/fill/crossings.h"
#include "mesh/fill/islands.h"
#include "mesh/validate/check.h"

namespace py = pybind11;

namespace fairing {
namespace {

// A mesh with holes and their fillings so far.
class Filler {
 public:
  Filler(const Numbers& vertices, const Ids& corners, const Ids& offsets)
      : mesh_(copy_of(vertices, corners, offsets)) {}

  // Loops, and dicts with reasons why other border edges surround no hole.
  py::tuple find(Monitor& monitor, const py::object& progress) {
    const auto lock = wait_for_others();
    FoundHoles found;
    run_once(monitor, progress, [&] { found = find_holes(mesh_.view(), half_edges()); });
    py::list unclear;
    for (const FairingError& error : found.unclear) unclear.append(to_python(error));
    return py::make_tuple(std::move(found.loops), unclear);
  }

  // The loops as holes with islands. Throws FairingError for loops that are not in the mesh.
  std::vector<Hole> with_islands(const std::vector<HoleLoop>& loops, Monitor& monitor,
                                 const py::object& progress) {
    const auto lock = wait_for_others();
    std::vector<Hole> holes;
    run_once(monitor, progress, [&] {
      for (const HoleLoop& loop : loops) holes.push_back({loop});
      for (const std::optional<FairingError>& why : check_holes(mesh_.view(), half_edges(), holes))
        if (why) throw FairingError(*why);
      holes = fairing::with_islands(mesh_.view(), half_edges(), holes);
    });
    return holes;
  }

  // The fillings of the holes that can be filled, and for each hole the reason why it is not
  // filled, a dict, or None.
  py::tuple fill(std::vector<Hole> holes, double density, bool bends, Monitor& monitor,
                 const py::object& progress) {
    const auto lock = wait_for_others();
    Refusals refusals;
    run_once(monitor, progress, [&] {
      holes_ = std::move(holes);
      refusals = check_holes(mesh_.view(), half_edges(), holes_);
      options_ = {.density = density, .bends = bends};
      filled_ = fairing::fill(mesh_.view(), half_edges(), holes_, options_, refusals);
    });
    py::list why;
    std::size_t kept = 0;
    for (std::size_t h = 0; h < refusals.size(); ++h) {
      why.append(refusals[h] ? py::object(to_python(*refusals[h])) : py::none());
      if (!refusals[h]) std::swap(holes_[kept++], holes_[h]);
    }
    holes_.resize(kept);
    return py::make_tuple(arrays(), why);
  }

  // `points`: (k, 3), of all new vertices; `chosen`: holes to refine, or, if `fair`, to shape.
  py::list refine(const Numbers& points, const std::vector<std::size_t>& chosen,
                  const std::vector<std::size_t>& fair, Monitor& monitor,
                  const py::object& progress) {
    const auto lock = wait_for_others();
    const std::vector<double> moved = copy_of(points);
    std::vector<std::uint8_t> flags(filled_.size(), 0), fair_flags = flags;
    for (const std::size_t hole : chosen) flags.at(hole) = 1;
    for (const std::size_t hole : fair) fair_flags.at(hole) = 1;
    std::size_t at = 0;
    for (FilledHole& hole : filled_)
      for (Vec3& p : hole.points) {
        p = Vec3(moved.at(at), moved.at(at + 1), moved.at(at + 2));
        at += 3;
      }
    run_once(monitor, progress, [&] {
      refine_again(mesh_.view(), half_edges(), holes_, options_, flags, fair_flags, filled_);
    });
    return arrays();
  }

 private:
  // One call at a time, since a call releases Python's lock.
  std::unique_lock<std::mutex> wait_for_others() {
    const py::gil_scoped_release released;
    return std::unique_lock(mutex_);
  }

  const HalfEdges& half_edges() {
    if (!half_edges_) {
      require_arrays(mesh_.view());
      half_edges_ = std::make_unique<HalfEdges>(mesh_.view());
    }
    return *half_edges_;
  }

  // For each hole its new vertices (k, 3) float64 and triangles (t, 3) int32.
  py::list arrays() const {
    py::list found;
    for (const FilledHole& hole : filled_) {
      Array<double> points;
      for (const Vec3& p : hole.points) points.insert(points.end(), p.begin(), p.end());
      Array<std::int32_t> triangles;
      for (const Triangle& t : hole.triangles)
        triangles.insert(triangles.end(), t.begin(), t.end());
      found.append(
          py::make_tuple(to_numpy(std::move(points), 3), to_numpy(std::move(triangles), 3)));
    }
    return found;
  }

  std::mutex mutex_;
  OwnedPolygonMesh mesh_;
  std::unique_ptr<HalfEdges> half_edges_;
  std::vector<Hole> holes_;
  FillOptions options_;
  std::vector<FilledHole> filled_;
};

// Throws FairingError(index_out_of_range) with the rows of the triangles.
void require_corners(const std::vector<std::int32_t>& corners, std::size_t points) {
  std::vector<std::int64_t> outside;
  for (std::size_t i = 0; i < corners.size(); ++i)
    if (corners[i] < 0 || std::size_t(corners[i]) >= points)
      if (outside.empty() || outside.back() != std::int64_t(i / 3))
        outside.push_back(std::int64_t(i / 3));
  if (!outside.empty())
    throw FairingError(ErrorCode::index_out_of_range,
                       "{face} {names|name} a vertex that does not exist: there are " +
                           std::to_string(points) + " points.",
                       outside);
}

// Numbers (k,) of the triangles (t, 3), from `first` on, that cross another; corners are ids in
// points (n, 3). Throws FairingError(bad_shape, index_out_of_range).
py::array crossings(const Numbers& points, const Contiguous<std::int32_t>& triangles,
                    std::size_t first, Monitor& monitor, const py::object& progress) {
  const std::vector<double> coordinates = copy_of(points);
  const std::vector<std::int32_t> corners = copy_of(triangles);
  require_corners(corners, coordinates.size() / 3);
  if (coordinates.size() % 3 != 0 || corners.size() % 3 != 0 || 3 * first > corners.size())
    throw FairingError(ErrorCode::bad_shape,
                       "Points and triangles need three columns, and `first` is one of the rows.");
  std::vector<Vec3> places;
  for (std::size_t i = 0; i < coordinates.size(); i += 3) places.emplace_back(&coordinates[i]);
  std::vector<Triangle> faces;
  for (std::size_t i = 0; i < corners.size(); i += 3)
    faces.push_back({corners[i], corners[i + 1], corners[i + 2]});
  std::vector<std::size_t> found;
  run_once(monitor, progress, [&] { found = crossing(places, faces, first); });
  return to_numpy(Array<std::int64_t>(found.begin(), found.end()), 1);
}

}  // namespace

void bind_fill(py::module_& m) {
  py::class_<Filler> filler(m, "Filler", "For the package's find_holes() and fill_holes().");
  define_constructor<const Numbers&, const Ids&, const Ids&>(filler, exact("vertices"),
                                                             exact("corners"), exact("offsets"));
  filler.def("find", &Filler::find, py::arg("monitor"), py::arg("progress"))
      .def("with_islands", &Filler::with_islands, py::arg("loops"), py::arg("monitor"),
           py::arg("progress"))
      .def("fill", &Filler::fill, py::arg("holes"), py::arg("density"), py::arg("bends"),
           py::arg("monitor"), py::arg("progress"))
      .def("refine", &Filler::refine, exact("points"), py::arg("chosen"), py::arg("fair"),
           py::arg("monitor"), py::arg("progress"));
  m.def("_crossings", &crossings, exact("points"), exact("triangles"), py::arg("first"),
        py::arg("monitor"), py::arg("progress"));
}

}  // namespace fairing
