// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/limit_surface.h"

#include <cmath>
#include <limits>

#include "base/points.h"
#include "grid/linear.h"
#include "grid/runs.h"

namespace fairing {
namespace {

// Whether every face is a quad of the input: then its points are those of the subdivided quads.
bool all_quads(const ControlMesh& control) {
  return control.vertex_count() == control.first_centre() &&
         std::all_of(control.faces.begin(), control.faces.end(),
                     [](const Face& face) { return face.quad(); });
}

// Whether the run is in a face amid flats or on its sides, or among faces beside such ones only.
bool is_on_flat(const ControlMesh& mesh, std::span<const Flatness> flatness, const Run& run) {
  Flatness least = Flatness::amid, most = Flatness::none;
  const auto count = [&](Index face) {
    if (face < 0) return;
    least = std::min(least, flatness[std::size_t(face)]);
    most = std::max(most, flatness[std::size_t(face)]);
  };
  if (run.kind == RunKind::vertex) {
    for (const Spoke& spoke : mesh.ring(run.element)) count(spoke.face);
  } else if (run.kind == RunKind::edge) {
    for (const Index s : mesh.edges[std::size_t(run.element)].side)
      if (s >= 0) count(mesh.sides[std::size_t(s)].face);
  } else {
    count(run.element);
  }
  return most == Flatness::amid || (most == Flatness::beside && least == Flatness::beside);
}

}  // namespace

// The places of a control face's points on its polygon, in steps of 1/n of a side:
//
// * a quad, and the parts of a split one: the unit square, its centre in the middle;
// * a triangle: each third, nearest to one corner, as the quad at that corner;
// * a fan around a polygon's centre: each triangle is half of the quads at its two corners.
class LimitSurface::FaceMap {
 public:
  FaceMap(const CatmullClark& subdivision, const GridLevel& grid, Index f)
      : subdivision_(subdivision),
        mesh_(grid.mesh()),
        face_(mesh_.faces[std::size_t(f)]),
        n_(grid.n()),
        first_(subdivision.corners(face_.polygon)),
        size_(subdivision.corners(face_.polygon + 1) - first_) {
    int missing = 0;
    for (int c = 0; c < face_.size; ++c) {
      corner_[c] = -1;
      for (Index k = 0; k < size_; ++k)
        if (subdivision.vertex(first_ + k) == mesh_.original_vertex(face_.vertex[std::size_t(c)]))
          corner_[c] = k;
      missing += corner_[c] < 0;
    }
    known_ = size_ == 4 || missing == (size_ == 3 ? 0 : 1);
  }

  bool known() const { return known_; }

  // Number of the point in the subdivided mesh.
  Index operator()(GridPoint p) const {
    if (size_ == 4) return in_square(p);
    std::array<std::pair<int, Index>, 3> weight;  // number of steps, corner
    weight[0] = {n_ - p.i - p.j, corner_[0]};
    weight[1] = {p.i, corner_[1]};
    weight[2] = {p.j, corner_[2]};
    if (size_ == 3) {
      std::sort(weight.begin(), weight.end(), std::greater<>());
      return near(weight[0].second, weight[1].second, 2 * weight[1].first + weight[2].first,
                  3 * weight[2].first);
    }
    // the centre is last
    std::sort(weight.begin(), weight.end(), [](const auto& a, const auto& b) {
      return std::pair(a.second >= 0, a.first) > std::pair(b.second >= 0, b.first);
    });
    return near(weight[0].second, weight[1].second, 2 * weight[1].first + weight[2].first,
                weight[2].first);
  }

 private:
  Index in_square(GridPoint p) const {
    const auto place = [&](int c) -> std::array<int, 2> {  // in halves of a side
      switch (corner_[c]) {
        case 0: return {0, 0};
        case 1: return {2, 0};
        case 2: return {2, 2};
        case 3: return {0, 2};
        default: return {1, 1};
      }
    };
    const auto from = place(0), along = place(1), across = place(face_.size - 1);
    int at[2];
    for (std::size_t a = 0; a < 2; ++a)
      at[a] = n_ * from[a] + p.i * (along[a] - from[a]) + p.j * (across[a] - from[a]);
    const auto [u, v] = at;
    const int far = 2 * n_;
    if (v <= n_) return u <= n_ ? quad(0, u, v) : quad(1, v, far - u);
    return u > n_ ? quad(2, far - u, far - v) : quad(3, far - v, u);
  }

  // a steps from one corner towards an adjacent one, and b steps towards the other side.
  Index near(Index corner, Index other, int a, int b) const {
    return other == (corner + 1) % size_ ? quad(corner, a, b) : quad(corner, b, a);
  }

  Index quad(Index corner, int a, int b) const {
    const int pieces = subdivision_.pieces();
    return subdivision_.point(face_.polygon, first_ + corner, a * pieces / n_, b * pieces / n_);
  }

  const CatmullClark& subdivision_;
  const ControlMesh& mesh_;
  const Face& face_;
  const int n_;
  const Index first_, size_;
  Index corner_[4];  // of the polygon, from 0; -1: its centre
  bool known_;
};

int LimitSurface::steps(const ControlMesh& control, int levels) {
  return std::max(1, levels + (all_quads(control) ? 0 : 1));
}

Array<double> LimitSurface::at_points(const GridLevel& grid, std::span<const double> cage,
                                      std::span<const Vec3> held, Workers& workers) const {
  const ControlMesh& mesh = grid.mesh();
  const Array<double> limits = subdivision_->limits(cage);
  Array<double> x(3 * grid.size());
  refine_linearly(grid, held, workers, x.data());
  const auto put = [&](const FaceMap& map, GridPoint at, Index p) {
    std::copy_n(limits.data() + 3 * std::size_t(map(at)), 3, x.data() + 3 * std::size_t(p));
  };
  for (Index c = mesh.first_centre(); c < mesh.vertex_count(); ++c) {
    const Spoke& spoke = mesh.ring(c)[0];
    const FaceMap map(*subdivision_, grid, spoke.face);
    if (map.known()) put(map, closed_point(false, grid.n(), spoke.corner, 0, 0), c);
  }
  for_edge_parts(grid, workers, [&](Index begin, Index end) {
    for (Index e = begin; e < end; ++e)
      for (const Index s : mesh.edges[std::size_t(e)].side) {
        if (s < 0) continue;
        const Side& side = mesh.sides[std::size_t(s)];
        const FaceMap map(*subdivision_, grid, side.face);
        if (!map.known()) continue;
        const bool quad = mesh.faces[std::size_t(side.face)].quad();
        for (int k = 1; k < grid.n(); ++k)
          put(map, closed_point(quad, grid.n(), side.local, k, 0), grid.side_point(side, k));
        break;
      }
  });
  for_face_parts(grid, workers, [&](Index begin, Index end) {
    for (Index f = begin; f < end; ++f) {
      const FaceMap map(*subdivision_, grid, f);
      if (!map.known()) continue;
      for_face_runs(grid, f, [&](const Run& run) {
        for (int i = 1; i <= int(run.count); ++i) put(map, {i, run.row}, Index(run.first) + i - 1);
      });
    }
  });
  return x;
}

Array<float> LimitSurface::penalty(const GridLevel& grid, std::span<const Vec3> control,
                                   Workers& workers) const {
  const ControlMesh& mesh = grid.mesh();
  const auto vertices = std::size_t(mesh.vertex_count());
  std::vector<double> shortest(vertices, INFINITY);
  for (std::size_t e = 0; e < mesh.edges.size(); ++e) {
    if (mesh.inside_polygon(Index(e))) continue;
    const auto [a, b] = mesh.edges[e].vertex;
    const double length = (control[std::size_t(a)] - control[std::size_t(b)]).norm();
    for (const Index v : {a, b})
      shortest[std::size_t(v)] = std::min(shortest[std::size_t(v)], length);
  }
  // the logarithm, and whether it is used
  std::vector<Vec3> at_vertex(vertices, Vec3::Zero());
  for (std::size_t v = 0; v < vertices; ++v)
    if (std::isfinite(shortest[v]))
      at_vertex[v] = {std::log(shortest[v]),
                      double(mesh.vertex_part(Index(v)) == RegionPart::inside), 0};
  for (Index c = mesh.first_centre(); c < mesh.vertex_count(); ++c) {
    Vec3 sum = Vec3::Zero();
    for (const Spoke& spoke : mesh.ring(c))
      sum += at_vertex[std::size_t(mesh.edges[std::size_t(spoke.edge)].vertex[spoke.outward])];
    if (!mesh.ring(c).empty()) at_vertex[std::size_t(c)] = sum / double(mesh.ring(c).size());
  }
  Array<double> at_point(3 * grid.size());
  refine_linearly(grid, at_vertex, workers, at_point.data());
  Array<float> out(grid.size());
  for_each_run(grid, workers, [&](const Run& run) {
    const bool is_flat = is_on_flat(mesh, flatness_, run);
    for (std::size_t p = run.first; p < run.first + run.count; ++p)
      out[p] = is_flat && at_point[3 * p + 1] == 1
                   ? std::numeric_limits<float>::infinity()
                   : float(std::pow(at_point[3 * p + 1], 0.25) * std::exp(-1.5 * at_point[3 * p]));
  });
  return out;
}

}  // namespace fairing
