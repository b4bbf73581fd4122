// SPDX-License-Identifier: GPL-3.0-or-later
#include "splines/fit.h"

#include <pybind11/pybind11.h>

#include <array>
#include <limits>

#include "binding/arrays.h"
#include "binding/bindings.h"
#include "binding/runner.h"
#include "splines/curve_data.h"
#include "splines/turns.h"

namespace py = pybind11;

namespace fairing {
namespace {

using ShortIds = Contiguous<std::int32_t>;

template <class T>
std::span<const T> view(const Contiguous<T>& a) {
  return {a.data(), std::size_t(a.size())};
}

// The points of all items in order. Items release theirs, so that memory is not doubled.
template <class Items, class PointsOf>
py::array points_array(Items& items, PointsOf&& points_of) {
  std::size_t count = 0;
  for (auto& item : items) count += points_of(item).size();
  Array<double> flat;
  flat.reserve(3 * count);
  for (auto& item : items) {
    for (const Vec3& p : points_of(item)) flat.insert(flat.end(), p.begin(), p.end());
    points_of(item) = {};
  }
  return to_numpy(std::move(flat), 3);
}

void add_edges(py::dict& to, std::vector<SplineEdge>& edges) {
  std::vector<std::int32_t> spans, vertices;
  std::vector<std::uint8_t> kinds;
  std::vector<double> errors;
  for (const SplineEdge& edge : edges) {
    spans.push_back(edge.curve.spans);
    vertices.insert(vertices.end(), edge.vertex.begin(), edge.vertex.end());
    kinds.push_back(std::uint8_t(edge.kind));
    errors.push_back(edge.error);
  }
  to["edge_spans"] = to_numpy(spans);
  to["edge_vertices"] = to_numpy(vertices, 2);
  to["edge_kind"] = to_numpy(kinds);
  to["edge_error"] = to_numpy(errors);
  to["edge_points"] =
      points_array(edges, [](SplineEdge& edge) -> auto& { return edge.curve.points; });
}

void add_patches(py::dict& to, SplineSurface& surface) {
  std::vector<std::int32_t> spans, loops;
  std::vector<std::int64_t> loop_offsets{0};
  std::vector<std::uint8_t> forward;
  for (const SplinePatch& patch : surface.patches) {
    spans.push_back(patch.spans_u);
    spans.push_back(patch.spans_v);
  }
  for (const std::vector<LoopEdge>& loop : surface.loops) {
    for (const LoopEdge& edge : loop) {
      loops.push_back(edge.edge);
      forward.push_back(edge.forward);
    }
    loop_offsets.push_back(std::int64_t(loops.size()));
  }
  to["patch_spans"] = to_numpy(spans, 2);
  to["patch_points"] =
      points_array(surface.patches, [](SplinePatch& patch) -> auto& { return patch.net; });
  std::vector<std::int32_t> faces;
  std::vector<std::int64_t> face_offsets{0};
  for (const std::vector<Index>& own : surface.faces) {
    faces.insert(faces.end(), own.begin(), own.end());
    face_offsets.push_back(std::int64_t(faces.size()));
  }
  to["patch_faces"] = to_numpy(faces);
  to["patch_face_offsets"] = to_numpy(face_offsets);
  to["face_off"] = to_numpy(surface.face_off);
  to["face_angle"] = to_numpy(surface.face_angle);
  to["loop_edges"] = to_numpy(loops);
  to["loop_forward"] = to_numpy(forward);
  to["loop_offsets"] = to_numpy(loop_offsets);
  to["residual"] = to_numpy(surface.residual);
  to["turned"] = to_numpy(surface.turned);
}

py::dict fit_arrays(const Numbers& vertices, const ShortIds& triangles, const ShortIds& quads,
                    const ShortIds& crease_edges, const ShortIds& groups, int levels,
                    double tolerance, double normal_tolerance, int threads, Monitor& monitor,
                    const py::object& progress) {
  // The arrays belong to the package; nobody else writes to them.
  const RefinedSurface refined{levels, view(vertices), view(triangles), view(quads),
                               view(crease_edges)};
  const SplineOptions options{.tolerance = tolerance,
                              .normal_tolerance = normal_tolerance,
                              .threads = threads,
                              .groups = view(groups)};
  SplineSurface surface;
  run_once(monitor, progress, [&] { surface = fit_splines(refined, options, monitor); });
  py::dict d;
  std::array corners{std::move(surface.vertices)};
  d["vertices"] = points_array(corners, [](std::vector<Vec3>& all) -> auto& { return all; });
  add_edges(d, surface.edges);
  add_patches(d, surface);
  d["angles"] = to_numpy(surface.angles, angles_an_edge);
  d["jumps"] = to_numpy(surface.jumps, angles_an_edge);
  d["lattice_turn"] = to_numpy(surface.lattice_turn);
  d["size"] = surface.size;
  return d;
}

py::array turns_array(const Numbers& vertices, const ShortIds& triangles, const ShortIds& quads,
                      const ShortIds& crease_edges, int levels, double least, int threads,
                      Monitor& monitor, const py::object& progress) {
  // The arrays belong to the package; nobody else writes to them.
  const RefinedSurface refined{levels, view(vertices), view(triangles), view(quads),
                               view(crease_edges)};
  std::vector<double> turns;
  run_once(monitor, progress, [&] {
    monitor.report(Phase::measure, 0);
    const Lattice lattice(refined);
    Workers workers(threads);
    Topology topology = make_topology(lattice);
    // slight turns count
    topology.kinks =
        CurveSource(lattice, topology, 0).kinks(std::numeric_limits<double>::infinity());
    turns = lattice_turns(lattice, topology, least, workers);
  });
  return to_numpy(turns);
}

}  // namespace

void bind_splines(py::module_& m) {
  m.def("lattice_turns", &turns_array, exact("vertices"), exact("triangles"), exact("quads"),
        exact("crease_edges"), py::arg("levels"), py::arg("least"), py::arg("threads"),
        py::arg("monitor"), py::arg("progress"),
        "By control faces, radians: the sharpest turn between two cells of a refined surface, of "
        "those at least `least` high.");
  m.def("fit_splines", &fit_arrays, exact("vertices"), exact("triangles"), exact("quads"),
        exact("crease_edges"), exact("groups"), py::arg("levels"), py::arg("tolerance"),
        py::arg("normal_tolerance"), py::arg("threads"), py::arg("monitor"), py::arg("progress"),
        "Patches of a refined surface, as flat arrays, which Patches of the package takes.");
}

}  // namespace fairing
