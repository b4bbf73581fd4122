// SPDX-License-Identifier: GPL-3.0-or-later
// The points after a step are numbered [vertices | edges | faces] of the previous level; face k of
// a level is the quad at corner k of the previous one.
#include "mesh/catmull_clark.h"

#include "base/points.h"
#include "mesh/limit_ring.h"
#include "parallel/cancel.h"

namespace fairing {
namespace {

using Points = Array<double>;

Eigen::Map<Vec3> at(Points& x, std::size_t p) { return Eigen::Map<Vec3>(x.data() + 3 * p); }
Vec3 at(std::span<const double> x, std::size_t p) { return point_at(x, std::int64_t(p)); }

}  // namespace

template <class Visit>
void CatmullClark::for_each_face(std::size_t level, Visit&& visit) const {
  for (const std::size_t f : Cancellable(faces(level))) {
    if (level == 0)
      visit(f, std::size_t(first_[f]), std::size_t(first_[f + 1]));
    else
      visit(f, 4 * f, 4 * f + 4);
  }
}

template <class Visit>
void CatmullClark::for_each_corner(std::size_t level, Visit&& visit) const {
  for_each_face(level, [&](std::size_t f, std::size_t first, std::size_t last) {
    for (std::size_t k = first; k < last; ++k) visit(f, k, k == first ? last - 1 : k - 1);
  });
}

CatmullClark::CatmullClark(const PolygonMesh& mesh, const ControlMesh& control,
                           const SharpRules& rules, int steps)
    : first_(mesh.offsets.begin(), mesh.offsets.end()) {
  set_polygons(mesh, control, rules);
  while (int(levels_.size()) < steps) refine();
}

void CatmullClark::set_polygons(const PolygonMesh& mesh, const ControlMesh& control,
                                const SharpRules& rules) {
  Level& level = levels_.emplace_back();
  level.vertices = Index(mesh.vertex_count());
  for (Index v = 0; v < level.vertices; ++v)
    if (control.vertex_part(v) != RegionPart::inside) stays_.push_back(v);
  level.vertex.assign(mesh.corners.begin(), mesh.corners.end());
  level.edge.resize(level.vertex.size());
  std::vector<std::pair<VertexPair, std::size_t>> sides(level.vertex.size());
  for_each_corner(0, [&](std::size_t, std::size_t k, std::size_t before) {
    sides[before] = {ascending(level.vertex[before], level.vertex[k]), before};
  });
  std::sort(sides.begin(), sides.end());
  for (std::size_t i = 0, next = 0; i < sides.size(); i = next) {
    const auto [a, b] = sides[i].first;
    const auto edge = Index(level.ends.size());
    for (; next < sides.size() && sides[next].first == sides[i].first; ++next)
      level.edge[sides[next].second] = edge;
    level.ends.push_back({Index(a), Index(b)});
    const double sharpness = next - i == 2 ? rules.edge(a, b) : sharp_for_ever;
    if (sharpness > 0) level.sharp_edges.emplace_back(edge, sharpness);
  }
  std::vector<std::pair<Index, double>> vertices;
  for (Index v = 0; v < level.vertices; ++v)
    if (rules.vertex(std::size_t(v)) > 0)
      vertices.emplace_back(v, rules.vertex(std::size_t(v)));
    else if (control.fans_meet(v))
      vertices.emplace_back(v, 0.0);
  set_specials(level, vertices);
  // an edge of three faces or more may pass through a vertex where fans meet
  for (Special& special : level.specials)
    if (control.fans_meet(special.vertex) && rule_of(special.sharp, 0) != VertexRule::crease)
      special.sharp.vertex = sharp_for_ever;
}

void CatmullClark::set_specials(Level& level,
                                const std::vector<std::pair<Index, double>>& vertices) {
  std::vector<std::pair<Index, std::size_t>> around;  // vertex, number of the sharp edge
  for (std::size_t i = 0; i < level.sharp_edges.size(); ++i)
    for (const Index v : level.ends[level.sharp_edges[i].first]) around.emplace_back(v, i);
  std::sort(around.begin(), around.end());
  auto spoke = around.begin();
  auto own = vertices.begin();
  while (spoke != around.end() || own != vertices.end()) {
    const Index v = spoke == around.end()   ? own->first
                    : own == vertices.end() ? spoke->first
                                            : std::min(spoke->first, own->first);
    Special& special = level.specials.emplace_back(Special{v, {}, {}});
    if (own != vertices.end() && own->first == v) special.sharp.vertex = (own++)->second;
    for (; spoke != around.end() && spoke->first == v; ++spoke) {
      const auto& [edge, sharpness] = level.sharp_edges[spoke->second];
      special.spokes.push_back(edge);
      special.sharp.spokes.push_back(sharpness);
    }
  }
}

void CatmullClark::refine() {
  const std::size_t last = levels_.size() - 1;
  Level next;
  {
    const Level& level = levels_[last];
    const auto edges = Index(level.ends.size());
    next.vertices = Index(level.size() + faces(last));
    next.ends.resize(2 * level.ends.size() + level.vertex.size());
    for (Index e = 0; e < edges; ++e)
      for (Index h = 0; h < 2; ++h) next.ends[2 * e + h] = {level.ends[e][h], level.vertices + e};
    next.vertex.resize(4 * level.vertex.size());
    next.edge.resize(4 * level.vertex.size());
    for_each_corner(last, [&](std::size_t f, std::size_t k, std::size_t before) {
      const Index v = level.vertex[k], e = level.edge[k], d = level.edge[before];
      const Index middle = level.vertices + edges + Index(f);
      const auto half = [&](Index edge) { return 2 * edge + (level.ends[edge][0] == v ? 0 : 1); };
      const std::array<Index, 4> vertex{v, level.vertices + e, middle, level.vertices + d},
          edge{half(e), 2 * edges + Index(k), 2 * edges + Index(before), half(d)};
      std::copy_n(vertex.begin(), 4, next.vertex.begin() + 4 * k);
      std::copy_n(edge.begin(), 4, next.edge.begin() + 4 * k);
      next.ends[std::size_t(2 * edges) + k] = {level.vertices + e, middle};
    });
    for (const auto& [edge, sharpness] : level.sharp_edges)
      for (Index h = 0; h < 2 && after(sharpness, 1) > 0; ++h)
        next.sharp_edges.emplace_back(2 * edge + h, after(sharpness, 1));
    std::vector<std::pair<Index, double>> vertices;
    for (const Special& special : level.specials)
      if (after(special.sharp.vertex, 1) > 0)
        vertices.emplace_back(special.vertex, after(special.sharp.vertex, 1));
    set_specials(next, vertices);
  }
  levels_.push_back(std::move(next));
}

Index CatmullClark::point(Index polygon, Index corner, int a, int b) const {
  Index face = polygon, k = corner;
  std::size_t l = 0;
  for (int half = pieces() / 2; half > 0; half /= 2) {
    const int far = 2 * half;
    face = k;
    if (a <= half && b <= half) {
      k = 4 * face;
    } else if (b <= half) {
      k = 4 * face + 1;
      a = std::exchange(b, far - a);
    } else if (a > half) {
      k = 4 * face + 2;
      a = far - a;
      b = far - b;
    } else {
      k = 4 * face + 3;
      b = std::exchange(a, far - b);
    }
    ++l;
  }
  const Level& level = levels_[l];
  const Index first = l == 0 ? corners(face) : 4 * face,
              last = l == 0 ? corners(face + 1) : first + 4;
  if (a == 0 && b == 0) return level.vertex[k];
  if (b == 0) return level.vertices + level.edge[k];
  if (a == 0) return level.vertices + level.edge[k == first ? last - 1 : k - 1];
  return Index(level.size()) + face;
}

Array<double> CatmullClark::step(std::size_t l, std::span<const double> x) const {
  const Level& level = levels_[l];
  const auto vertices = std::size_t(level.vertices);
  Points out(3 * (level.size() + faces(l)), 0.0);
  Array<Index> valence(vertices, 0);
  for_each_face(l, [&](std::size_t f, std::size_t first, std::size_t last) {
    auto middle = at(out, level.size() + f);
    for (std::size_t k = first; k < last; ++k)
      middle += at(x, std::size_t(level.vertex[k])) / double(last - first);
    for (std::size_t k = first; k < last; ++k) {
      at(out, vertices + std::size_t(level.edge[k])) += middle / 4;
      at(out, std::size_t(level.vertex[k])) += middle;
    }
  });
  for (const std::size_t e : Cancellable(level.ends.size())) {
    const auto a = std::size_t(level.ends[e][0]), b = std::size_t(level.ends[e][1]);
    at(out, vertices + e) += (at(x, a) + at(x, b)) / 4;
    at(out, a) += at(x, b);
    at(out, b) += at(x, a);
    ++valence[a];
    ++valence[b];
  }
  for (const std::size_t v : Cancellable(vertices)) {
    const double n = valence[v];
    auto to = at(out, v);
    to = n > 0 ? Vec3((n - 2) / n * at(x, v) + to / (n * n)) : at(x, v);
  }
  for (const auto& [e, sharpness] : level.sharp_edges) {
    const auto [a, b] = level.ends[e];
    const double share = std::min(1.0, sharpness);
    auto to = at(out, vertices + std::size_t(e));
    const Vec3 middle = (at(x, std::size_t(a)) + at(x, std::size_t(b))) / 2;
    to = share < 1 ? Vec3(share * middle + (1 - share) * to) : middle;
  }
  for (const Special& special : level.specials) {
    const auto v = std::size_t(special.vertex);
    const Vec3 smooth = at(out, v);
    at(out, v) = by_rules(special.sharp, 0, [&](VertexRule rule, int steps) -> Vec3 {
      if (rule == VertexRule::smooth) return smooth;
      if (rule == VertexRule::corner) return at(x, v);
      Vec3 sum = 0.75 * at(x, v);
      for (std::size_t i = 0; i < special.spokes.size(); ++i) {
        const auto [a, b] = level.ends[special.spokes[i]];
        if (after(special.sharp.spokes[i], steps) > 0)
          sum += 0.125 * at(x, std::size_t(a == special.vertex ? b : a));
      }
      return sum;
    });
  }
  return out;
}

// x: the points after the step of that level.
Array<double> CatmullClark::to_limit(std::size_t l, std::span<const double> x) const {
  const Level& level = levels_[l];
  const auto vertices = std::size_t(level.vertices);
  const auto edge = [&](std::size_t k) { return vertices + std::size_t(level.edge[k]); };
  Points out(x.size(), 0.0);
  Array<Index> valence(vertices, 0);
  for_each_face(l, [&](std::size_t f, std::size_t first, std::size_t last) {
    const double n = double(last - first);
    const Vec3 middle = at(x, level.size() + f);
    Vec3 sum = n * n * middle;
    for (std::size_t k = first, before = last - 1; k < last; before = k++) {
      const Vec3 end = at(x, edge(k)), begin = at(x, edge(before));
      sum += 4 * end + at(x, std::size_t(level.vertex[k]));
      at(out, edge(k)) += 4 * middle + begin;
      at(out, edge(before)) += end;
      at(out, std::size_t(level.vertex[k])) += middle;
    }
    at(out, level.size() + f) = sum / (n * (n + 5));
  });
  for (const std::size_t e : Cancellable(level.ends.size())) {
    const Vec3 own = at(x, vertices + e);
    auto to = at(out, vertices + e);
    to += 16 * own;
    for (const Index v : level.ends[e]) {
      to += 4 * at(x, std::size_t(v));
      at(out, std::size_t(v)) += 4 * own;
      ++valence[v];
    }
    to /= 36;
  }
  for (const std::size_t v : Cancellable(vertices)) {
    const double n = valence[v];
    auto to = at(out, v);
    to = n > 0 ? Vec3((n * n * at(x, v) + to) / (n * (n + 5))) : at(x, v);
  }
  for (const auto& [e, sharpness] : level.sharp_edges) {
    const double share = std::min(1.0, after(sharpness, 1));
    const auto [a, b] = level.ends[e];
    auto to = at(out, vertices + std::size_t(e));
    const Vec3 on_crease =
        (4 * at(x, vertices + std::size_t(e)) + at(x, std::size_t(a)) + at(x, std::size_t(b))) / 6;
    to = share < 1 ? Vec3(share * on_crease + (1 - share) * to) : on_crease;
  }
  for (const Special& special : level.specials) {
    const auto v = std::size_t(special.vertex);
    const Vec3 smooth = at(out, v);
    at(out, v) = by_rules(special.sharp, 1, [&](VertexRule rule, int steps) -> Vec3 {
      if (rule == VertexRule::smooth) return smooth;
      if (rule == VertexRule::corner) return at(x, v);
      Vec3 sum = 4 * at(x, v);
      for (std::size_t i = 0; i < special.spokes.size(); ++i)
        if (after(special.sharp.spokes[i], steps) > 0)
          sum += at(x, vertices + std::size_t(special.spokes[i]));
      return sum / 6;
    });
  }
  return out;
}

Array<double> CatmullClark::limits(std::span<const double> cage) const {
  Points x(cage.begin(), cage.end());
  for (std::size_t l = 0; l < levels_.size(); ++l) x = step(l, x);
  return to_limit(levels_.size() - 1, x);
}

std::vector<double> CatmullClark::vertex_limits(std::span<const double> cage) const {
  const Array<double> x = step(0, cage), all = to_limit(0, x);
  std::vector<double> limits(all.begin(), all.begin() + cage.size());
  put_exact_limits(x, limits);
  for (const Index v : stays_)
    std::copy_n(cage.begin() + 3 * std::ptrdiff_t(v), 3, limits.begin() + 3 * std::ptrdiff_t(v));
  return limits;
}

// Limits that need many steps, computed on their rings only. x: the points after the first step.
void CatmullClark::put_exact_limits(std::span<const double> x, std::vector<double>& limits) const {
  const Level& level = levels_[0];
  const auto vertices = std::size_t(level.vertices);
  std::vector<Index> which(vertices, -1);                // number of the ring
  std::vector<std::vector<std::array<Index, 3>>> rings;  // of each corner: both edges and the face
  std::vector<const Special*> specials;
  for (const Special& special : level.specials)
    if (takes_many_steps(special.sharp)) {
      which[special.vertex] = Index(rings.size());
      rings.emplace_back();
      specials.push_back(&special);
    }
  if (rings.empty()) return;
  for_each_corner(0, [&](std::size_t f, std::size_t k, std::size_t before) {
    if (const Index r = which[level.vertex[k]]; r >= 0)
      rings[r].push_back({level.edge[before], level.edge[k], Index(f)});
  });
  for (const std::size_t r : Cancellable(rings.size())) {
    if (rings[r].empty()) continue;  // a vertex without faces stays
    const Special& special = *specials[r];
    LimitRing ring{at(x, std::size_t(special.vertex)), {}, {}};
    AroundVertex sharp{special.sharp.vertex, {}};
    std::vector<Index> edges;
    const auto spoke = [&](Index e) {
      const auto known = std::ranges::find(edges, e);
      const auto i = std::size_t(known - edges.begin());
      if (known != edges.end()) return i;
      edges.push_back(e);
      ring.spokes.push_back(at(x, vertices + std::size_t(e)));
      const auto own = std::ranges::find(special.spokes, e);
      sharp.spokes.push_back(
          own == special.spokes.end() ? 0 : special.sharp.spokes[own - special.spokes.begin()]);
      return i;
    };
    for (const auto& [a, b, f] : rings[r]) {
      const std::size_t first = spoke(a), second = spoke(b);
      ring.quads.push_back({at(x, level.size() + std::size_t(f)), {first, second}});
    }
    const Vec3 limit = limit_of(std::move(ring), sharp);
    std::copy_n(limit.data(), 3, limits.data() + 3 * std::size_t(special.vertex));
  }
}

}  // namespace fairing
