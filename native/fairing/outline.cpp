// SPDX-License-Identifier: GPL-3.0-or-later
#include "fairing/outline.h"

#include <utility>

#include "curves/feature_curves.h"
#include "fairing/checked.h"
#include "fairing/control_positions.h"
#include "fairing/fair.h"
#include "fairing/held_positions.h"
#include "fairing/mending.h"
#include "mesh/orientation.h"
#include "parallel/cancel.h"

namespace fairing {
namespace {

// Number of a control vertex in the result, without copies.
std::int32_t joined(const ControlMesh& mesh, Index v) {
  const Index original = mesh.original_vertex(v);
  return original < mesh.input_vertices ? original : original - Index(mesh.copies.vertex.size());
}

void set_faces(const ControlMesh& mesh, Outline& out) {
  for (const Index f : Cancellable(mesh.first_copied_face())) {
    const Face& face = mesh.faces[f];
    out.polygon.push_back(std::int32_t(face.polygon));
    for (std::size_t s = 0; s < 4; ++s) {
      const bool is_side = s < std::size_t(face.size);
      const Side side = is_side ? mesh.sides[std::size_t(face.first_side) + s] : Side{};
      out.face.push_back(is_side ? joined(mesh, face.vertex[s]) : -1);
      out.side_edge.push_back(is_side ? mesh.original_edge(side.edge) : -1);
      out.side_reversed.push_back(is_side && side.reversed);
    }
  }
}

void set_edges(const ControlMesh& mesh, Outline& out) {
  for (const Index e : Cancellable(mesh.first_copied_edge())) {
    const Edge& edge = mesh.edges[e];
    for (const Index v : edge.vertex) out.edge.push_back(joined(mesh, v));
    const bool boundary = edge.boundary() && !mesh.nonmanifold(e);
    out.edge_kind.push_back(std::uint8_t((mesh.feature_edge[e] ? curve_edge : 0) |
                                         (boundary ? boundary_edge : 0) |
                                         (mesh.inside_polygon(e) ? split_edge : 0)));
  }
  for (const Chain& chain : mesh.features())
    for (const Index e : chain.edges)
      if (chain.straight && e < mesh.first_copied_edge()) out.edge_kind[e] |= straight_edge;
}

// Sets curves and centres of the mesh and its shapes. `held`: one position a control vertex.
void set_surfaces(const ControlMesh& mesh, const HeldMesh& held, Outline& out) {
  const CurveScheme scheme = out.options.curve_scheme();
  const auto append = [&](const FeatureCurves& curves, std::span<const Vec3> world) {
    for (Index c = mesh.first_centre(); c < mesh.first_copied_centre(); ++c) {
      const Vec3& centre = world[c];
      out.centres.insert(out.centres.end(), centre.data(), centre.data() + 3);
    }
    for (const Index e : out.curve)
      for (const Vec3& p : curves.of(e))
        out.curve_points.insert(out.curve_points.end(), p.data(), p.data() + 3);
  };
  const FeatureCurves own = refine_feature_edges(mesh, held.world, held.world, scheme);
  for (Index e = 0; e < mesh.first_copied_edge(); ++e)
    if (own.run[e] >= 0) out.curve.push_back(e);
  append(own, held.world);
  const std::size_t size = out.mesh.coordinates.size();
  for (std::size_t s = 0; s * size < out.shapes.size(); ++s) {
    const std::span<const double> shape = std::span(out.shapes).subspan(s * size, size);
    const std::vector<Vec3> world = all_positions(mesh, held.world, held.rule.of(shape));
    append(refine_feature_edges(mesh, held.world, world, scheme), world);
  }
}

Outline outline_of(const Mending& mending) {
  Outline out;
  out.options = mending.options();
  const FairOptions& options = out.options;
  check_options(mending.mesh(), options);
  check_mesh(mending.mesh(), options, out.report);
  check_shapes(mending.mesh(), options.shapes);
  out.shapes.assign(options.shapes.begin(), options.shapes.end());
  ControlMesh mesh = make_control_mesh(mending.mesh(), options.features, out.report.flipped_faces);
  out.report.sheets = sheets_of(mesh);
  out.mesh = with_flipped(mending.mesh(), out.report.flipped_faces);
  if (mending.mended()) out.mended = *mending.mended();
  set_faces(mesh, out);
  set_edges(mesh, out);
  HeldMesh held = held_positions(mending.mesh(), mesh, options);
  set_surfaces(mesh, held, out);
  mesh.positions = std::move(held.world);
  out.units = measure_units(mesh, options.curve_scheme().exponent);
  mending.restore(out.report);
  out.options.shapes = {};  // they belong to `mending`
  return out;
}

}  // namespace

Outline outline_of(const PolygonMesh& input, const FairOptions& options, Monitor& monitor) {
  const CancelScope scope(&monitor);
  return with_named_errors([&] {
    const Mending mending(input, options);
    return mending.in_input_ids([&] { return outline_of(mending); });
  });
}

}  // namespace fairing
