// SPDX-License-Identifier: GPL-3.0-or-later
#include "strain/load_matrix.h"

#include <algorithm>

#include "parallel/cancel.h"

namespace fairing {
namespace {

// Calls visit(u) for all vertices that share an edge or a quad with v.
template <class Visit>
void visit_neighbours(const ControlMesh& mesh, Index v, Visit&& visit) {
  for (const Spoke& spoke : mesh.ring(v)) {
    visit(mesh.end_of(spoke));
    if (spoke.face < 0 || !mesh.faces[spoke.face].quad()) continue;
    visit(mesh.faces[spoke.face].vertex[std::size_t(spoke.corner + 2) % 4]);
  }
}

// The vertices around a vertex, ring after ring, by way of faces.
class Rings {
 public:
  explicit Rings(const ControlMesh& mesh)
      : mesh_(mesh), seen_(std::size_t(mesh.vertex_count()), -1) {}

  // v, its copies, and all vertices at most `rings` rings away from them.
  const std::vector<Index>& around(Index v, int rings) {
    found_.clear();
    mesh_.for_each_copy(v, [&](Index u) { add(u, v); });
    for (std::size_t begin = 0; rings > 0 && begin < found_.size(); --rings) {
      const std::size_t end = found_.size();
      for (; begin < end; ++begin) {
        stop_if_cancelled(begin);
        visit_neighbours(mesh_, found_[begin], [&](Index u) { add(u, v); });
      }
    }
    return found_;
  }

 private:
  void add(Index u, Index from) {
    if (seen_[u] == from) return;
    seen_[u] = from;
    found_.push_back(u);
  }

  const ControlMesh& mesh_;
  std::vector<Index> seen_;  // the last vertex that each was reached from
  std::vector<Index> found_;
};

// Sets of vertices on pads whose members are at least `rings_apart` rings apart; copies of a vertex
// count as one. Deterministic.
std::vector<std::vector<Index>> vertices_apart(const ControlMesh& mesh, const Pads& pads,
                                               int rings) {
  std::vector<std::vector<Index>> sets;
  std::vector<Index> set_of(std::size_t(mesh.vertex_count()), -1);
  std::vector<Index> too_near;  // of each set: the last vertex that is too near to it
  Rings rings_of(mesh);
  for (Index v = 0; v < mesh.input_vertices; ++v) {
    if (!pads.under(std::size_t(v))) continue;
    for (const Index u : rings_of.around(v, rings - 1))
      if (set_of[u] >= 0) too_near[set_of[u]] = v;
    const auto set = std::size_t(
        std::find_if(too_near.begin(), too_near.end(), [&](Index of) { return of != v; }) -
        too_near.begin());
    if (set == sets.size()) {
      sets.emplace_back();
      too_near.push_back(-1);
    }
    sets[set].push_back(v);
    mesh.for_each_copy(v, [&](Index u) { set_of[u] = Index(set); });
  }
  return sets;
}

// For each control vertex the nearest member of a set by number of rings, the first of several; -1
// if none is reached. Copies of a vertex are as near as it is.
std::vector<Index> nearest_of(const ControlMesh& mesh, const std::vector<Index>& set) {
  std::vector<Index> nearest(std::size_t(mesh.vertex_count()), -1), found;
  const auto add = [&](Index u, Index from) {
    mesh.for_each_copy(mesh.original_vertex(u), [&](Index copy) {
      if (nearest[copy] >= 0) return;
      nearest[copy] = from;
      found.push_back(copy);
    });
  };
  for (const Index v : set) add(v, v);
  for (std::size_t i = 0; i < found.size(); ++i) {
    stop_if_cancelled(i);
    visit_neighbours(mesh, found[i], [&](Index u) { add(u, nearest[found[i]]); });
  }
  return nearest;
}

using OnLoads = std::function<void(std::size_t set, const std::vector<double>& loads)>;

// Calls on_loads(s, loads) for each set s in order. `loads`, one number a control vertex, are those
// after a move by one of all vertices of the set. `on_part`, if given, is called before each solve
// with its part of the whole.
void probe_loads(FairingSystems& systems, const std::vector<std::vector<Index>>& sets,
                 const OnPart& on_part, const OnLoads& on_loads) {
  const ControlMesh& mesh = systems.finest().mesh();
  systems.plate().keep_smoother();
  std::vector<Vec3> targets(std::size_t(mesh.vertex_count()));
  std::vector<double> loads(targets.size());
  for (std::size_t first = 0; first < sets.size(); first += 3) {
    const std::size_t end = std::min(first + 3, sets.size());
    if (on_part) on_part(double(first) / double(sets.size()), double(end) / double(sets.size()));
    std::fill(targets.begin(), targets.end(), Vec3::Zero());
    for (std::size_t s = first; s < end; ++s)
      for (const Index v : sets[s])
        mesh.for_each_copy(v, [&](Index u) { targets[u][s - first] = 1; });
    const Loads found = systems.loads_of_moves(targets);
    for (std::size_t s = first; s < end; ++s) {
      for (std::size_t v = 0; v < loads.size(); ++v) loads[v] = found[v][s - first];
      on_loads(s, loads);
    }
  }
}

}  // namespace

void visit_around(
    const ControlMesh& mesh, const std::vector<Index>& vertices, int rings,
    const std::function<void(std::size_t i, const std::vector<Index>& around)>& visit) {
  Rings rings_of(mesh);
  for (std::size_t i = 0; i < vertices.size(); ++i) visit(i, rings_of.around(vertices[i], rings));
}

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
