// SPDX-License-Identifier: GPL-3.0-or-later
// A limit position is a row of weights. It is found from its end: the mask of the limit, for a ring
// on which nothing is semi-sharp any more, is taken back through one subdivision step after another,
// each a sparse map of ring to ring, to the polygons around the vertex.
#include "mesh/limit_positions.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "base/error.h"
#include "base/points.h"
#include "mesh/buckets.h"
#include "mesh/groups.h"
#include "mesh/half_edges.h"
#include "mesh/vertex_pair.h"
#include "parallel/cancel.h"

namespace fairing {
namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();

struct RingSpoke {
  Index to;
  double sharpness = 0;
  int faces = 0;
};

struct RingFace {
  Index face;
  std::size_t spoke[2];
};

// The polygons around one vertex, in no order.
struct PolygonRing {
  std::vector<RingSpoke> spokes;
  std::vector<RingFace> faces;
  double sharpness = 0;  // of the vertex
};

// Weights of a ring's points: the vertex itself, the ends of its spokes, and a point of each face,
// on the polygons the mean of its corners, on later rings the corner across.
struct RingWeights {
  double vertex = 0;
  std::vector<double> spoke, face;
};

// How sharp something of this sharpness is after some steps.
double after(double sharpness, int steps) { return std::max(0.0, sharpness - steps); }

enum class VertexRule { smooth, crease, corner };

VertexRule rule_of(const PolygonRing& ring, int steps) {
  if (after(ring.sharpness, steps) > 0) return VertexRule::corner;
  const auto sharp =
      std::count_if(ring.spokes.begin(), ring.spokes.end(),
                    [&](const RingSpoke& spoke) { return after(spoke.sharpness, steps) > 0; });
  return sharp < 2 ? VertexRule::smooth : sharp == 2 ? VertexRule::crease : VertexRule::corner;
}

// While a vertex goes from one rule to the next its sharpness is between 0 and 1: the share that the
// former has [DeRose, Kass, Truong 1998, §3], the mean of all that become smooth.
double share_of_sharper(const PolygonRing& ring, int steps) {
  double sum = 0;
  int count = 0;
  const auto add = [&](double sharpness) {
    const double now = after(sharpness, steps);
    if (!(now > 0 && now <= 1)) return;
    sum += now;
    ++count;
  };
  add(ring.sharpness);
  for (const RingSpoke& spoke : ring.spokes) add(spoke.sharpness);
  return count ? sum / count : 0;
}

// out += share of the mask by which a vertex rule makes a point of the ring. `vertex`, `spoke` and
// `face` are what the rule gives each of them; on a crease, only the two sharp spokes.
void add_mask(const PolygonRing& ring, VertexRule rule, int steps, const double (&smooth)[3],
              const double (&crease)[2], double share, RingWeights& out) {
  if (rule == VertexRule::corner) {
    out.vertex += share;
    return;
  }
  if (rule == VertexRule::crease) {
    out.vertex += share * crease[0];
    for (std::size_t i = 0; i < ring.spokes.size(); ++i)
      if (after(ring.spokes[i].sharpness, steps) > 0) out.spoke[i] += share * crease[1];
    return;
  }
  out.vertex += share * smooth[0];
  for (double& weight : out.spoke) weight += share * smooth[1];
  for (double& weight : out.face) weight += share * smooth[2];
}

RingWeights no_weights(const PolygonRing& ring) {
  return {0, std::vector<double>(ring.spokes.size(), 0.0),
          std::vector<double>(ring.faces.size(), 0.0)};
}

// Weights on the ring after step `steps` -> weights on the ring before it. The first step is that of
// polygons.
RingWeights before_step(const PolygonRing& ring, int steps, const RingWeights& later) {
  RingWeights out = no_weights(ring);
  const double n = double(ring.spokes.size());
  // the vertex, with faces by their face points
  const double smooth[]{(n - 2) / n, 1 / (n * n), 1 / (n * n)};
  const double crease[]{0.75, 0.125};
  const VertexRule now = rule_of(ring, steps), next = rule_of(ring, steps + 1);
  const double share = now == next || now == VertexRule::smooth ? 1 : share_of_sharper(ring, steps);
  add_mask(ring, now, steps, smooth, crease, later.vertex * share, out);
  add_mask(ring, next, steps + 1, smooth, crease, later.vertex * (1 - share), out);
  // edge points: of a sharp edge its middle, else the mean with the face points beside it
  std::vector<double> beside(ring.spokes.size(), 0.0);
  for (std::size_t i = 0; i < ring.spokes.size(); ++i) {
    const double sharp = std::min(1.0, after(ring.spokes[i].sharpness, steps));
    const double end = later.spoke[i] * (0.25 + 0.25 * sharp);
    out.vertex += end;
    out.spoke[i] += end;
    beside[i] = later.spoke[i] * 0.25 * (1 - sharp);
  }
  for (std::size_t j = 0; j < ring.faces.size(); ++j) {
    const auto [a, b] = ring.faces[j].spoke;
    out.face[j] += later.face[j];
    out.face[j] += beside[a] + beside[b];
    if (steps == 0) continue;
    const double quarter = out.face[j] /= 4;  // face points of quads
    out.vertex += quarter;
    out.spoke[a] += quarter;
    out.spoke[b] += quarter;
  }
  return out;
}

// Whether a crease ends in the vertex, where the rule is smooth all the same.
bool is_dart(const PolygonRing& ring, int steps) {
  return rule_of(ring, steps) == VertexRule::smooth &&
         std::any_of(ring.spokes.begin(), ring.spokes.end(),
                     [&](const RingSpoke& spoke) { return after(spoke.sharpness, steps) > 0; });
}

// Of the limit on a ring of quads where what is sharp stays so.
RingWeights limit_mask(const PolygonRing& ring, int steps) {
  RingWeights out = no_weights(ring);
  const double n = double(ring.spokes.size());
  const double smooth[]{n / (n + 5), 4 / (n * (n + 5)), 1 / (n * (n + 5))};
  add_mask(ring, rule_of(ring, steps), steps, smooth, {2.0 / 3, 1.0 / 6}, 1, out);
  if (!is_dart(ring, steps)) return out;
  // The mask is what steps leave as it is. What is left of a start shrinks by two thirds a step at the
  // most, the second eigenvalue for high valences: two steps take a binary digit at least.
  for (int k = 0; k < 2 * std::numeric_limits<double>::digits; ++k)
    out = before_step(ring, steps, out);
  return out;
}

// How many steps it takes until nothing is semi-sharp; at least the one of polygons.
int steps_to_limit(const PolygonRing& ring) {
  double most = std::isfinite(ring.sharpness) ? ring.sharpness : 0;
  for (const RingSpoke& spoke : ring.spokes)
    if (std::isfinite(spoke.sharpness)) most = std::max(most, spoke.sharpness);
  return std::max(1, int(std::ceil(most)));
}

RingWeights weights_of(const PolygonRing& ring) {
  const int steps = steps_to_limit(ring);
  RingWeights weights = limit_mask(ring, steps);
  for (int s = steps; s-- > 0;) weights = before_step(ring, s, weights);
  return weights;
}

using SharpEdge = std::pair<VertexPair, double>;

double forever(double sharpness) { return sharpness >= always_sharp ? infinite : sharpness; }

// Sorted by edge. What is given comes before the feature edge that it may be as well.
std::vector<SharpEdge> sharp_edges(const ControlMesh& control, const Sharpness& given) {
  std::vector<SharpEdge> found;
  const auto& [pairs, values] = given.edges;
  for (std::size_t k = 0; k < pairs.size(); ++k)
    if (values[k] > 0) found.emplace_back(ascending(pairs[k][0], pairs[k][1]), forever(values[k]));
  for (Index e = 0; e < control.first_copied_edge(); ++e) {
    if (!control.feature_edge[std::size_t(e)] || control.inside_polygon(e)) continue;
    const auto [a, b] = control.edges[std::size_t(e)].vertex;
    found.emplace_back(ascending(control.original_vertex(a), control.original_vertex(b)), infinite);
  }
  std::stable_sort(found.begin(), found.end(),
                   [](const SharpEdge& a, const SharpEdge& b) { return a.first < b.first; });
  return found;
}

double sharpness_of(const std::vector<SharpEdge>& edges, std::int64_t a, std::int64_t b) {
  const auto edge = ascending(a, b);
  const auto at = std::lower_bound(
      edges.begin(), edges.end(), edge,
      [](const SharpEdge& sharp, const auto& wanted) { return sharp.first < wanted; });
  return at == edges.end() || at->first != edge ? 0 : at->second;
}

// Of every vertex: infinite where it stays, whatever is around it.
std::vector<double> vertex_sharpness(const ControlMesh& control,
                                     std::span<const std::int64_t> corners,
                                     const Sharpness& given) {
  const auto count = std::size_t(control.input_vertices);
  std::vector<double> out(count, 0.0);
  std::vector<int> ends(count, 0);
  for (const Chain& chain : control.chains) {
    if (!chain.closed) ++ends[std::size_t(chain.vertices.front())];
    if (!chain.closed) ++ends[std::size_t(chain.vertices.back())];
    if (chain.straight)
      for (const Index v : chain.vertices) out[std::size_t(v)] = infinite;
  }
  for (std::size_t v = 0; v < count; ++v)
    if (ends[v] == 2) out[v] = infinite;  // one curve, cut in two: it turns sharply
  for (const std::int64_t v : corners) out[std::size_t(v)] = infinite;
  for (std::size_t v = 0; v < given.vertices.size(); ++v)
    if (given.vertices[v] > 0) out[v] = forever(given.vertices[v]);
  return out;
}

// The rings of all vertices, one after the other.
class PolygonRings {
 public:
  PolygonRings(const PolygonMesh& mesh, std::vector<SharpEdge> edges)
      : half_edges_(mesh),
        edges_(std::move(edges)),
        corners_(
            std::size_t(mesh.vertex_count()), mesh.corners.size(),
            [&](std::size_t k) { return mesh.corners[k]; },
            [](std::size_t k) { return Index(k); }) {}

  // Valid until the next call.
  const PolygonRing& at(std::size_t v, double sharpness) {
    ring_.spokes.clear();
    ring_.faces.clear();
    ends_.clear();
    for (const Index k : corners_.of(v)) {
      const auto [before, behind] = neighbours(k);
      ends_.insert(ends_.end(), {before, behind});
    }
    std::sort(ends_.begin(), ends_.end());
    ends_.erase(std::unique(ends_.begin(), ends_.end()), ends_.end());
    for (const std::int64_t u : ends_)
      ring_.spokes.push_back({Index(u), sharpness_of(edges_, std::int64_t(v), u), 0});
    for (const Index k : corners_.of(v)) {
      const auto [before, behind] = neighbours(k);
      const RingFace face{half_edges_.face(k), {spoke(before), spoke(behind)}};
      for (const std::size_t i : face.spoke) ++ring_.spokes[i].faces;
      ring_.faces.push_back(face);
    }
    for (RingSpoke& spoke : ring_.spokes)
      if (spoke.faces != 2) spoke.sharpness = infinite;
    ring_.sharpness = meets_itself() ? infinite : sharpness;
    return ring_;
  }

 private:
  std::array<std::int64_t, 2> neighbours(Index k) const {
    return {half_edges_.from(half_edges_.previous(k)), half_edges_.from(half_edges_.next(k))};
  }
  std::size_t spoke(std::int64_t end) const {
    return std::size_t(std::lower_bound(ends_.begin(), ends_.end(), end) - ends_.begin());
  }

  // Whether several fans of faces are around the vertex. One edge of three faces or more may pass
  // through it all the same.
  bool meets_itself() const {
    if (ring_.faces.empty() || rule_of(ring_, 0) == VertexRule::crease) return false;
    Groups joined(ring_.spokes.size());
    std::size_t fans = ring_.spokes.size();
    for (const RingFace& face : ring_.faces)
      fans -= joined.unite(Index(face.spoke[0]), Index(face.spoke[1]));
    return fans > 1;
  }

  const HalfEdges half_edges_;
  std::vector<SharpEdge> edges_;
  Buckets<Index> corners_;  // by vertex
  std::vector<std::int64_t> ends_;
  PolygonRing ring_;
};

}  // namespace

void check_edge_sharpness(std::int64_t vertices, const Sharpness& sharpness) {
  const auto refuse = [](const std::string& message, std::vector<std::int64_t> elements = {}) {
    throw FairingError(ErrorCode::bad_option, message, std::move(elements), ElementKind::vertex);
  };
  const auto& [pairs, values] = sharpness.edges;
  if (pairs.size() != values.size())
    refuse("edge_sharpness has " + std::to_string(values.size()) + " values for " +
           std::to_string(pairs.size()) + " edges; give one for each edge.");
  std::vector<std::int64_t> unknown, bad;
  for (std::size_t k = 0; k < pairs.size(); ++k)
    for (const std::int64_t v : pairs[k]) {
      if (v < 0 || v >= vertices) unknown.push_back(v);
      if (!(values[k] >= 0)) bad.push_back(v);
    }
  if (!unknown.empty())
    throw FairingError(ErrorCode::index_out_of_range,
                       listing(vertex_s, unknown, {"is", "are"}) +
                           " named by edge_sharpness but not in the mesh: ids run from 0 to " +
                           std::to_string(vertices - 1) + ".",
                       unknown, ElementKind::vertex);
  if (!bad.empty())
    refuse("edge_sharpness must be zero or positive; see the edge of the vertices " +
               std::to_string(bad[0]) + " and " + std::to_string(bad[1]) + ".",
           bad);
}

LimitPositions::LimitPositions(const PolygonMesh& mesh, const ControlMesh& control,
                               std::span<const std::int64_t> corners, const Sharpness& sharpness,
                               double share)
    : share_(share),
      corners_(mesh.corners.begin(), mesh.corners.end()),
      offsets_(mesh.offsets.begin(), mesh.offsets.end()) {
  const std::vector<double> sharp = vertex_sharpness(control, corners, sharpness);
  PolygonRings rings(mesh, sharp_edges(control, sharpness));
  first_.push_back(0);
  target_.reserve(2 * mesh.corners.size());
  weight_.reserve(2 * mesh.corners.size());
  const auto add = [&](Index target, double weight) {
    if (weight == 0) return;
    target_.push_back(target);
    weight_.push_back(weight);
  };
  for (std::size_t v = 0; v < sharp.size(); ++v) {
    stop_if_cancelled(v);
    if (sharp[v] < infinite && control.vertex_part(Index(v)) == RegionPart::inside) {
      const PolygonRing& ring = rings.at(v, sharp[v]);
      if (!ring.faces.empty()) {
        const RingWeights weights = weights_of(ring);
        for (std::size_t i = 0; i < ring.spokes.size(); ++i)
          add(ring.spokes[i].to, weights.spoke[i]);
        for (std::size_t j = 0; j < ring.faces.size(); ++j)
          add(-1 - ring.faces[j].face, weights.face[j]);
      }
    }
    first_.push_back(target_.size());
  }
}

std::vector<double> LimitPositions::of(std::span<const double> cage) const {
  const auto at = [&](Index v) { return point_at(cage, v); };
  std::vector<Vec3> middle(offsets_.size() - 1, Vec3::Zero());
  for (std::size_t f = 0; f < middle.size(); ++f) {
    stop_if_cancelled(f);
    for (Index k = offsets_[f]; k < offsets_[f + 1]; ++k)
      middle[f] += at(corners_[std::size_t(k)]) / double(offsets_[f + 1] - offsets_[f]);
  }
  std::vector<double> out(cage.begin(), cage.end());
  for (std::size_t v = 0; v + 1 < first_.size(); ++v) {
    const Vec3 here = at(Index(v));
    Vec3 offset = Vec3::Zero();
    for (std::size_t k = first_[v]; k < first_[v + 1]; ++k) {
      const Index target = target_[k];
      offset += weight_[k] * ((target < 0 ? middle[std::size_t(-1 - target)] : at(target)) - here);
    }
    if (first_[v] == first_[v + 1]) continue;  // stays, to the last bit
    for (std::size_t a = 0; a < 3; ++a) out[3 * v + a] += share_ * offset[Eigen::Index(a)];
  }
  return out;
}

std::size_t LimitPositions::bytes(const PolygonMesh& mesh) {
  return mesh.corners.size() * (sizeof(Index) + 2 * (sizeof(Index) + sizeof(double))) +
         mesh.offsets.size() * (sizeof(Index) + sizeof(Vec3)) +
         std::size_t(mesh.vertex_count() + 1) * sizeof(std::size_t);
}

}  // namespace fairing
