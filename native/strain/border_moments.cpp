// SPDX-License-Identifier: GPL-3.0-or-later
#include "strain/border_moments.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <unordered_map>

#include "mesh/normal.h"
#include "parallel/cancel.h"
#include "strain/stretches.h"

namespace fairing {
namespace {

// The faces around a control vertex in its chart.
struct Star {
  std::vector<Vec2> ring;
  std::vector<Vec3> at;     // in space, relative to the vertex
  std::vector<Index> edge;  // from each point of the ring to the next
};

Star star_of(const ControlMesh& mesh, const ChartMaker& charts, std::span<const Vec3> positions,
             Index v) {
  Star out{charts.vertex(v).ring, {}, {}};
  const auto add = [&](const Face& face, int corner) {
    const auto c = std::size_t(corner % face.size);
    out.at.push_back(positions[face.vertex[c]] - positions[v]);
    out.edge.push_back(mesh.sides[std::size_t(face.first_side) + c].edge);
  };
  for (const Spoke& spoke : mesh.ring(v)) {
    const Face& face = mesh.faces[spoke.face];
    for (int k = 1; k + 1 < face.size; ++k) add(face, spoke.corner + k);
  }
  return out;
}

// Where a ray from the vertex leaves its star: distance in the chart, and offset in space.
struct Exit {
  double distance = 0;
  Vec3 at = Vec3::Zero();
};

double cross(const Vec2& a, const Vec2& b) { return a.x() * b.y() - a.y() * b.x(); }

Exit leave(const Star& star, const Vec2& direction) {
  const std::size_t m = star.ring.size();
  for (std::size_t k = 0; k < m; ++k) {
    const Vec2 &a = star.ring[k], &b = star.ring[(k + 1) % m];
    const double before = cross(a, direction), behind = cross(direction, b);
    if (before < 0 || behind < 0 || !(before + behind > 0)) continue;
    const double t = before / (before + behind);
    return {((1 - t) * a + t * b).dot(direction), (1 - t) * star.at[k] + t * star.at[(k + 1) % m]};
  }
  return {};
}

// Second derivative of the control mesh across an edge of the ring.
Vec3 bend_across(const Star& star, Index edge) {
  const auto k =
      std::size_t(std::find(star.edge.begin(), star.edge.end(), edge) - star.edge.begin());
  const Vec2 along = star.ring[(k + 1) % star.ring.size()] - star.ring[k];
  const Vec2 outwards = Vec2(along.y(), -along.x()).normalized();
  const Exit to = leave(star, outwards), from = leave(star, -outwards);
  if (!(to.distance > 0 && from.distance > 0)) return Vec3::Zero();
  return 2 / (to.distance + from.distance) * (to.at / to.distance + from.at / from.distance);
}

// A stretch of a curve from one side: its edges, and the vertices on pads that face them.
class Row {
 public:
  Row(const GridLevel& grid, const ChartMaker& charts, const Pads& pads, const Unknowns& unknowns,
      std::span<const Vec3> positions)
      : grid_(grid),
        mesh_(grid.mesh()),
        charts_(charts),
        pads_(pads),
        unknowns_(unknowns),
        positions_(positions) {}

  // Adds the next edge by one of its sides, in the direction of the stretch or the opposite one.
  void add(const Side& side, bool along) {
    sides_.push_back(&side);
    const Face& face = mesh_.faces[side.face];
    for (int k = 2; k < face.size; ++k)
      add_vertex(far_corner(side, along ? face.size + 1 - k : k), side.edge);
  }

  // Adds the forces of all rows to `forces`.
  void bend(bool closed, std::vector<double>& forces) {
    if (beside_.empty()) return;
    if (forces.empty()) forces.resize(3 * grid_.size());
    set_medians(closed);
    for (const Side* side : sides_) bend_face(*side, forces);
  }

 private:
  struct Beside {
    Index vertex;
    Vec3 normal;
    double bend;  // along the normal
    int edges;    // number of edges in the sum
  };

  Index far_corner(const Side& side, int k) const {
    const Face& face = mesh_.faces[side.face];
    return face.vertex[(side.local + k) % face.size];
  }

  void add_vertex(Index v, Index edge) {
    if (v >= mesh_.input_vertices || !mesh_.interior(v) || !pads_.under(std::size_t(v))) return;
    const Vec3 bend = bend_across(star_of(mesh_, charts_, positions_, v), edge);
    if (Beside* const known = find(v)) {
      known->bend += bend.dot(known->normal);
      ++known->edges;
    } else {
      const Vec3 normal = control_normal(mesh_, v).stableNormalized();
      beside_.push_back({v, normal, bend.dot(normal), 1});
    }
  }

  // Finds v among the last two and, on a closed curve, the first.
  Beside* find(Index v) {
    const std::size_t m = beside_.size();
    for (std::size_t k = m; k-- > 0 && k + 2 >= m;)
      if (beside_[k].vertex == v) return &beside_[k];
    return m > 0 && beside_[0].vertex == v ? &beside_[0] : nullptr;
  }

  void set_medians(bool closed) {
    const std::size_t m = beside_.size();
    std::vector<double> own;
    for (const Beside& each : beside_) own.push_back(each.bend / each.edges);
    for (std::size_t k = 0; k < m; ++k) {
      std::vector<double> near{own[k]};
      if (k > 0 || closed) near.push_back(own[(k + m - 1) % m]);
      if (k + 1 < m || closed) near.push_back(own[(k + 1) % m]);
      std::sort(near.begin(), near.end());
      const double median = 0.5 * (near[near.size() / 2] + near[(near.size() - 1) / 2]);
      bend_of_[beside_[k].vertex] = median * beside_[k].normal;
    }
  }

  // A moment on the border changes the energy of the first row of points: the force there times the
  // distance there is one for each piece of the border.
  void bend_face(const Side& side, std::vector<double>& forces) const {
    const Face& face = mesh_.faces[side.face];
    const FlatFace& flat = charts_.flat()[side.face];
    const auto first = bend_of_.find(far_corner(side, face.size - 1)),
               second = bend_of_.find(far_corner(side, 2));
    if (first == bend_of_.end() && second == bend_of_.end()) return;
    const Vec3 a = (first == bend_of_.end() ? second : first)->second;
    const Vec3 b = (second == bend_of_.end() ? first : second)->second;
    const double length = flat.length[side.local];
    const double height = (face.quad() ? 1 : 2) * flat.area / length;
    const int n = grid_.n(), last = face.quad() ? n : n - 1;
    for (int k = 0; k <= last; ++k) {
      if (!is_unknown(side, k == 0 ? -1 : k == last ? 1 : 0)) continue;
      const double t = double(k) / n, share = face.quad() && (k == 0 || k == last) ? 0.5 : 1;
      const Index point =
          grid_.face_point(side.face, closed_point(face.quad(), n, side.local, k, 1));
      Eigen::Map<Vec3>(forces.data() + 3 * std::size_t(point)) -=
          share * length / height * ((1 - t) * a + t * b);
    }
  }

  // Position relative to the side: -1 is before it, 1 after it.
  bool is_unknown(const Side& side, int at) const {
    const Face& face = mesh_.faces[side.face];
    if (at == 0) return unknowns_.has_face(std::size_t(side.face));
    const int other = (side.local + face.size + at) % face.size;
    const Side& beside = mesh_.sides[face.first_side + other];
    return unknowns_.edge[beside.edge] != 0;
  }

  const GridLevel& grid_;
  const ControlMesh& mesh_;
  const ChartMaker& charts_;
  const Pads& pads_;
  const Unknowns& unknowns_;
  std::span<const Vec3> positions_;
  std::vector<const Side*> sides_;
  std::vector<Beside> beside_;
  std::unordered_map<Index, Vec3> bend_of_;
};

}  // namespace

std::vector<double> border_moments(const GridLevel& grid, const ChartMaker& charts,
                                   const Pads& pads, const Unknowns& unknowns,
                                   std::span<const Vec3> positions) {
  const ControlMesh& mesh = grid.mesh();
  std::vector<double> forces;
  for (const Chain& chain : mesh.features())
    for (const Stretch& stretch : stretches_of(chain, positions))
      for (const bool along : {true, false}) {
        Row row(grid, charts, pads, unknowns, positions);
        for (const std::size_t k : Cancellable(stretch.edges.size())) {
          const Edge& edge = mesh.edges[stretch.edges[k]];
          const bool runs = edge.vertex[0] == stretch.vertices[k];
          const Index side = edge.side[runs == along ? 0 : 1];
          if (side >= 0) row.add(mesh.sides[side], along);
        }
        row.bend(stretch.closed, forces);
      }
  return forces;
}

}  // namespace fairing
