// SPDX-License-Identifier: GPL-3.0-or-later
// A limit position is a row of weights. It is found from its end: the mask of the limit, for a ring
// on which nothing is semi-sharp any more, is taken back through one subdivision step after another,
// each a sparse map of ring to ring, to the polygons around the vertex.
#include "mesh/limit_positions.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/points.h"
#include "mesh/buckets.h"
#include "mesh/groups.h"
#include "mesh/half_edges.h"
#include "parallel/cancel.h"

namespace fairing {
namespace {

struct RingFace {
  Index face;
  std::size_t spoke[2];
};

// The polygons around one vertex, in no order.
struct PolygonRing {
  std::vector<Index> spokes;  // where they lead
  std::vector<RingFace> faces;
  AroundVertex sharp;
};

// Weights of a ring's points: the vertex itself, the ends of its spokes, and a point of each face,
// on the polygons the mean of its corners, on later rings the corner across.
struct RingWeights {
  double vertex = 0;
  std::vector<double> spoke, face;
};

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
      if (after(ring.sharp.spokes[i], steps) > 0) out.spoke[i] += share * crease[1];
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
  const VertexRule now = rule_of(ring.sharp, steps), next = rule_of(ring.sharp, steps + 1);
  const double share =
      now == next || now == VertexRule::smooth ? 1 : share_of_sharper(ring.sharp, steps);
  add_mask(ring, now, steps, smooth, crease, later.vertex * share, out);
  add_mask(ring, next, steps + 1, smooth, crease, later.vertex * (1 - share), out);
  // edge points: of a sharp edge its middle, else the mean with the face points beside it
  std::vector<double> beside(ring.spokes.size(), 0.0);
  for (std::size_t i = 0; i < ring.spokes.size(); ++i) {
    const double sharp = std::min(1.0, after(ring.sharp.spokes[i], steps));
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
  return rule_of(ring.sharp, steps) == VertexRule::smooth &&
         std::any_of(ring.sharp.spokes.begin(), ring.sharp.spokes.end(),
                     [&](double sharpness) { return after(sharpness, steps) > 0; });
}

// Of the limit on a ring of quads where what is sharp stays so.
RingWeights limit_mask(const PolygonRing& ring, int steps) {
  RingWeights out = no_weights(ring);
  const double n = double(ring.spokes.size());
  const double smooth[]{n / (n + 5), 4 / (n * (n + 5)), 1 / (n * (n + 5))};
  add_mask(ring, rule_of(ring.sharp, steps), steps, smooth, {2.0 / 3, 1.0 / 6}, 1, out);
  if (!is_dart(ring, steps)) return out;
  // The mask is what steps leave as it is. What is left of a start shrinks by two thirds a step at the
  // most, the second eigenvalue for high valences: two steps take a binary digit at least.
  for (int k = 0; k < 2 * std::numeric_limits<double>::digits; ++k)
    out = before_step(ring, steps, out);
  return out;
}

// How many steps it takes until nothing is semi-sharp; at least the one of polygons.
int steps_to_limit(const PolygonRing& ring) {
  double most = std::isfinite(ring.sharp.vertex) ? ring.sharp.vertex : 0;
  for (const double sharpness : ring.sharp.spokes)
    if (std::isfinite(sharpness)) most = std::max(most, sharpness);
  return std::max(1, int(std::ceil(most)));
}

RingWeights weights_of(const PolygonRing& ring) {
  const int steps = steps_to_limit(ring);
  RingWeights weights = limit_mask(ring, steps);
  for (int s = steps; s-- > 0;) weights = before_step(ring, s, weights);
  return weights;
}

// The rings of all vertices, one after the other.
class PolygonRings {
 public:
  PolygonRings(const PolygonMesh& mesh, const SharpRules& rules)
      : half_edges_(mesh),
        rules_(rules),
        corners_(
            std::size_t(mesh.vertex_count()), mesh.corners.size(),
            [&](std::size_t k) { return mesh.corners[k]; },
            [](std::size_t k) { return Index(k); }) {}

  // Valid until the next call.
  const PolygonRing& at(std::size_t v) {
    ring_.faces.clear();
    std::vector<Index>& ends = ring_.spokes;
    ends.clear();
    for (const Index k : corners_.of(v)) {
      const auto [before, behind] = neighbours(k);
      ends.insert(ends.end(), {Index(before), Index(behind)});
    }
    std::sort(ends.begin(), ends.end());
    ends.erase(std::unique(ends.begin(), ends.end()), ends.end());
    std::vector<int> faces(ends.size(), 0);
    for (const Index k : corners_.of(v)) {
      const auto [before, behind] = neighbours(k);
      const RingFace face{half_edges_.face(k), {spoke(before), spoke(behind)}};
      for (const std::size_t i : face.spoke) ++faces[i];
      ring_.faces.push_back(face);
    }
    std::vector<double>& sharp = ring_.sharp.spokes;
    sharp.clear();
    for (std::size_t i = 0; i < ends.size(); ++i)
      sharp.push_back(faces[i] == 2 ? rules_.edge(std::int64_t(v), ends[i]) : sharp_for_ever);
    ring_.sharp.vertex = rules_.vertex(v);
    if (meets_itself()) ring_.sharp.vertex = sharp_for_ever;
    return ring_;
  }

 private:
  std::array<std::int64_t, 2> neighbours(Index k) const {
    return {half_edges_.from(half_edges_.previous(k)), half_edges_.from(half_edges_.next(k))};
  }
  std::size_t spoke(std::int64_t end) const {
    return std::size_t(std::lower_bound(ring_.spokes.begin(), ring_.spokes.end(), end) -
                       ring_.spokes.begin());
  }

  // Whether several fans of faces are around the vertex. One edge of three faces or more may pass
  // through it all the same.
  bool meets_itself() const {
    if (ring_.faces.empty() || rule_of(ring_.sharp, 0) == VertexRule::crease) return false;
    Groups joined(ring_.spokes.size());
    std::size_t fans = ring_.spokes.size();
    for (const RingFace& face : ring_.faces)
      fans -= joined.unite(Index(face.spoke[0]), Index(face.spoke[1]));
    return fans > 1;
  }

  const HalfEdges half_edges_;
  const SharpRules& rules_;
  Buckets<Index> corners_;  // by vertex
  PolygonRing ring_;
};

}  // namespace

LimitPositions::LimitPositions(const PolygonMesh& mesh, const ControlMesh& control,
                               const SharpRules& rules)
    : corners_(mesh.corners.begin(), mesh.corners.end()),
      offsets_(mesh.offsets.begin(), mesh.offsets.end()) {
  const auto vertices = std::size_t(mesh.vertex_count());
  PolygonRings rings(mesh, rules);
  first_.push_back(0);
  target_.reserve(2 * mesh.corners.size());
  weight_.reserve(2 * mesh.corners.size());
  const auto add = [&](Index target, double weight) {
    if (weight == 0) return;
    target_.push_back(target);
    weight_.push_back(weight);
  };
  for (std::size_t v = 0; v < vertices; ++v) {
    stop_if_cancelled(v);
    if (rules.vertex(v) < sharp_for_ever && control.vertex_part(Index(v)) == RegionPart::inside) {
      const PolygonRing& ring = rings.at(v);
      if (!ring.faces.empty()) {
        const RingWeights weights = weights_of(ring);
        for (std::size_t i = 0; i < ring.spokes.size(); ++i) add(ring.spokes[i], weights.spoke[i]);
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
    for (std::size_t a = 0; a < 3; ++a) out[3 * v + a] += offset[Eigen::Index(a)];
  }
  return out;
}

std::size_t LimitPositions::bytes(const PolygonMesh& mesh) {
  return mesh.corners.size() * (sizeof(Index) + 2 * (sizeof(Index) + sizeof(double))) +
         mesh.offsets.size() * (sizeof(Index) + sizeof(Vec3)) +
         std::size_t(mesh.vertex_count() + 1) * sizeof(std::size_t);
}

}  // namespace fairing
