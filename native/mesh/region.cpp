// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/region.h"

#include <algorithm>

#include "base/error.h"
#include "mesh/sheets.h"
#include "parallel/cancel.h"

namespace fairing {
namespace {

// The part of a vertex or edge with faces of these kinds.
RegionPart part_of(bool some_inside, bool some_outside) {
  if (!some_inside) return RegionPart::outside;
  return some_outside ? RegionPart::joint : RegionPart::inside;
}

RegionPart vertex_part(const ControlMesh& control, Index v) {
  bool touches[2] = {false, false};
  for (const Spoke& spoke : control.ring(v))
    if (spoke.face >= 0) touches[control.region.face[spoke.face] == RegionPart::outside] = true;
  return part_of(touches[0], touches[1]);
}

RegionPart edge_part(const ControlMesh& control, const Edge& edge) {
  bool touches[2] = {false, false};
  for (const Index side : edge.side)
    if (side >= 0)
      touches[control.region.face[control.sides[side].face] == RegionPart::outside] = true;
  return part_of(touches[0], touches[1]);
}

// Where sheets meet, all of them are inside the region, outside, or on its joint.
void join_sheets(ControlMesh& control) {
  if (control.copies.edge.empty()) return;
  Region& region = control.region;
  const auto meet = [](RegionPart& first, RegionPart other) {
    if (first != other) first = RegionPart::joint;
  };
  const auto original = [&](Index e) -> RegionPart& {
    return region.edge[control.original_edge(e)];
  };
  for (Index e = control.first_copied_edge(); e < Index(control.edges.size()); ++e)
    meet(original(e), region.edge[e]);
  for (Index e = control.first_copied_edge(); e < Index(control.edges.size()); ++e)
    region.edge[e] = original(e);
  const JoinedVertices joined(control);
  const auto first = [&](Index v) -> RegionPart& { return region.vertex[joined.first(v)]; };
  for (Index v = 0; v < control.vertex_count(); ++v) meet(first(v), region.vertex[v]);
  for (Index v = 0; v < control.vertex_count(); ++v) region.vertex[v] = first(v);
}

// Of edges and vertices, from those of the faces.
void set_parts(ControlMesh& control) {
  Region& region = control.region;
  region.edge.clear();
  region.vertex.clear();
  for (const Edge& edge : control.edges) {
    stop_if_cancelled(region.edge.size());
    region.edge.push_back(edge_part(control, edge));
  }
  for (const Index v : Cancellable(control.vertex_count()))
    region.vertex.push_back(vertex_part(control, v));
  join_sheets(control);
}

}  // namespace

std::vector<std::uint8_t> flags_of_faces(std::span<const std::int64_t> faces, std::int64_t count,
                                         const std::string& where) {
  std::vector<std::uint8_t> flags(std::size_t(count), 0);
  std::vector<std::int64_t> unknown;
  for (const std::int64_t f : faces)
    if (f < 0 || f >= count)
      unknown.push_back(f);
    else
      flags[f] = 1;
  if (!unknown.empty())
    throw FairingError(ErrorCode::index_out_of_range,
                       "{face} {is|are} named in " + where +
                           " but not in the mesh: ids run from 0 to " + std::to_string(count - 1) +
                           ".",
                       unknown, ElementKind::face);
  return flags;
}

std::vector<std::uint8_t> chosen_faces(const RegionOptions& options, std::int64_t count) {
  if (options.faces.empty())
    throw FairingError(
        ErrorCode::bad_option,
        "region has no faces: name those to be faired, or give no region to fair all.");
  return flags_of_faces(options.faces, count, "the region");
}

void find_region(const RegionOptions& options, ControlMesh& control) {
  if (!options.given) return;
  const std::vector<std::uint8_t> chosen = chosen_faces(options, control.input_faces);
  if (std::find(chosen.begin(), chosen.end(), 0) == chosen.end()) return;
  control.region.joint = options.joint;
  for (const Face& face : control.faces)
    control.region.face.push_back(chosen[face.polygon] ? RegionPart::inside : RegionPart::outside);
  set_parts(control);
}

void put_outside(std::span<const std::uint8_t> faces, ControlMesh& control) {
  Region& region = control.region;
  if (region.whole()) region.face.assign(control.faces.size(), RegionPart::inside);
  for (std::size_t f = 0; f < faces.size(); ++f)
    if (faces[f]) region.face[f] = RegionPart::outside;
  set_parts(control);
}

void mark_clamped_joint(ControlMesh& control) {
  Region& region = control.region;
  if (region.whole() || region.joint == RegionContinuity::position) return;
  region.clamped_edge.assign(control.edges.size(), 0);
  region.clamped_vertex.assign(std::size_t(control.vertex_count()), 0);
  for (std::size_t e = 0; e < control.edges.size(); ++e) {
    if (region.edge[e] != RegionPart::joint || !control.edge_fit(Index(e))) continue;
    region.clamped_edge[e] = 1;
    for (const Index v : control.edges[e].vertex) region.clamped_vertex[v] = 1;
  }
}

}  // namespace fairing
