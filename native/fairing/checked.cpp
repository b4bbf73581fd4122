// SPDX-License-Identifier: GPL-3.0-or-later
#include "fairing/checked.h"

#include <algorithm>
#include <utility>

#include "mesh/sheets.h"
#include "mesh/validate/check.h"

namespace fairing {
namespace {

void require_two_sides(const std::vector<Warning>& warnings) {
  for (const Warning& warning : warnings)
    if (warning.code == name(ErrorCode::non_orientable))
      throw FairingError(
          ErrorCode::non_orientable,
          {"{face} {belongs|belong} to a surface with only one side, like a Möbius strip.",
           "Only the thin plate accepts it: the other energies need normals that agree "
           "everywhere. Use energy=\"thin_plate\", or cut it open."},
          warning.elements);
}

}  // namespace

void check_mesh(const PolygonMesh& input, const FairOptions& options, Report& report) {
  CheckResult checked = check(input, {options.repair == Repair::mend});
  if (options.energy != Energy::thin_plate) require_two_sides(checked.warnings);
  report.warnings = std::move(checked.warnings);
  report.flipped_faces = std::move(checked.flipped_faces);
}

SheetReport sheets_of(const ControlMesh& mesh) {
  SheetReport out;
  const SheetNumbers sheets = number_sheets(mesh);
  out.count = std::size_t(sheets.count);
  std::vector<std::uint8_t> one_sided(std::size_t(mesh.vertex_count()), 0);
  for (Index f = mesh.first_copied_face(); f < Index(mesh.faces.size()); ++f)
    one_sided[sheets.of_vertex[mesh.faces[f].vertex[0]]] = 1;
  out.one_sided = std::size_t(std::count(one_sided.begin(), one_sided.end(), 1));
  std::vector<std::uint8_t> on_edge(std::size_t(mesh.input_vertices), 0);
  for (Index e = 0; e < mesh.first_copied_edge(); ++e) {
    if (!mesh.nonmanifold(e)) continue;
    ++out.nonmanifold_edges;
    for (const Index v : mesh.edges[e].vertex) on_edge[mesh.original_vertex(v)] = 1;
  }
  for (Index v = 0; v < mesh.input_vertices; ++v)
    out.nonmanifold_vertices += mesh.fans_meet(v) && !on_edge[v];
  return out;
}

}  // namespace fairing
