// SPDX-License-Identifier: GPL-3.0-or-later
#include "strain/load_matrix.h"

#include <algorithm>

#include "parallel/cancel.h"

namespace fairing {
std::vector<Index> numbered(std::size_t count, std::span<const Index> vertices) {
  std::vector<Index> number(count, -1);
  for (std::size_t i = 0; i < vertices.size(); ++i) number[vertices[i]] = Index(i);
  return number;
}

ProbedMatrix load_matrix(FairingSystems& systems, const std::vector<Index>& vertices,
                         int rings_apart, const OnPart& on_part) {
  const ControlMesh& mesh = systems.finest().mesh();
  const std::vector<std::vector<Index>> sets =
      vertices_apart(mesh, *systems.plate().pads(), rings_apart);
  const std::vector<Index> column = numbered(std::size_t(mesh.vertex_count()), vertices);
  std::vector<std::vector<std::pair<Index, double>>> rows(vertices.size());
  probe_loads(systems, sets, on_part, [&](std::size_t set, const std::vector<double>& loads) {
    const std::vector<Index> nearest = nearest_of(mesh, sets[set]);
    for (std::size_t i = 0; i < vertices.size(); ++i) {
      const auto v = std::size_t(vertices[i]);
      const Index from = nearest[v] < 0 ? -1 : column[nearest[v]];
      if (from >= 0) rows[i].emplace_back(from, loads[v]);
    }
  });
  ProbedMatrix out;
  out.solves = int((sets.size() + 2) / 3);
  const auto n = Eigen::Index(vertices.size());
  out.g.resize(n, n);
  std::size_t entries = 0;
  for (auto& row : rows) {
    std::sort(row.begin(), row.end());
    entries += row.size();
  }
  out.g.reserve(Eigen::Index(entries));
  for (const std::size_t i : Cancellable(rows.size())) {
    out.g.startVec(Eigen::Index(i));
    for (const auto& [from, load] : rows[i])
      out.g.insertBack(Eigen::Index(i), Eigen::Index(from)) = load;
    rows[i] = {};
  }
  out.g.finalize();
  return out;
}

std::size_t bytes_of_load_matrix(std::size_t vertices, int rings_apart) {
  // usual number of sets in a mesh of triangles and quads; more around vertices of high valence
  const auto usual_sets = std::size_t(rings_apart * rings_apart + rings_apart);
  // once as rows, and twice as a matrix, for a product with its transpose
  return vertices * usual_sets *
         (sizeof(std::pair<Index, double>) + 2 * (sizeof(double) + sizeof(Index)));
}

}  // namespace fairing
