// SPDX-License-Identifier: GPL-3.0-or-later
#include "strain/probes.h"

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

}  // namespace

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

void visit_around(
    const ControlMesh& mesh, const std::vector<Index>& vertices, int rings,
    const std::function<void(std::size_t i, const std::vector<Index>& around)>& visit) {
  Rings rings_of(mesh);
  for (std::size_t i = 0; i < vertices.size(); ++i) visit(i, rings_of.around(vertices[i], rings));
}

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

}  // namespace fairing
