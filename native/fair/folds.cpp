// SPDX-License-Identifier: GPL-3.0-or-later
#include "fair/folds.h"

#include <Eigen/Geometry>

#include "lattice/accumulate.h"
#include "lattice/linear.h"
#include "lattice/ring.h"

namespace fairing {
namespace {

// Of the ways to cut the quads: those in which an edge has to be folded.
enum class Cut { any, every };

using Point = Eigen::Map<const Vec3>;

// Triangles p q r and q p s.
bool is_folded(const Point& p, const Point& q, const Point& r, const Point& s) {
  const Vec3 along = q - p;
  return along.cross(r - p).dot((s - p).cross(along)) < 0;
}

// The corners that triangles on one side of an edge may have for their third: a quad's may have two.
struct Corners {
  const double* at[2];
  int count;
};

bool is_folded(Cut cut, const double* p, const double* q, const Corners& left, const Corners& right) {
  int folded = 0;
  for (int l = 0; l < left.count; ++l)
    for (int r = 0; r < right.count; ++r)
      folded += is_folded(Point(p), Point(q), Point(left.at[l]), Point(right.at[r]));
  return cut == Cut::any ? folded > 0 : folded == left.count * right.count;
}

// Calls visit(a, b) for every folded edge inside a face, a and b in closed coordinates.
template <class Visit>
void visit_in_face(Cut cut, bool quad, int n, const double* closed, Visit&& visit) {
  const auto at = [&](LatticePoint p) {
    return closed + 3 * (closed_row(quad, std::size_t(n), std::size_t(p.j)) + std::size_t(p.i));
  };
  const auto look = [&](LatticePoint a, LatticePoint b, LatticePoint left, LatticePoint right) {
    const bool folded = is_folded(Point(at(a)), Point(at(b)), Point(at(left)), Point(at(right)));
    if (folded) visit(a, b);
  };
  if (!quad) {  // every edge inside belongs to one triangle that points down
    for (int j = 0; j + 1 < n; ++j)
      for (int i = 0; i + j + 1 < n; ++i) {
        const LatticePoint a{i + 1, j}, b{i + 1, j + 1}, c{i, j + 1};
        look(a, b, c, {i + 2, j});
        look(b, c, a, {i, j + 2});
        look(c, a, b, {i, j});
      }
    return;
  }
  const auto look_both = [&](LatticePoint a, LatticePoint b, LatticePoint left, LatticePoint right) {
    const auto beside = [&](LatticePoint p) {
      return Corners{{at(p), at({p.i + b.i - a.i, p.j + b.j - a.j})}, 2};
    };
    if (is_folded(cut, at(a), at(b), beside(left), beside(right))) visit(a, b);
  };
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) {
      const LatticePoint a{i, j}, b{i + 1, j}, c{i + 1, j + 1}, d{i, j + 1};
      if (cut == Cut::any || is_folded(Point(at(b)), Point(at(d)), Point(at(a)), Point(at(c))))
        look(a, c, d, b);
      if (cut == Cut::any) look(b, d, a, c);
      if (j > 0) look_both(a, b, d, {i, j - 1});
      if (i > 0) look_both(a, d, {i - 1, j}, b);
    }
}

// Calls visit(k) for every folded piece k … k + 1 of a control edge.
template <class Visit>
void visit_on_edge(Cut cut, const Lattice& lattice, Index e, const double* x, std::vector<double>& scratch,
                   Visit&& visit) {
  const ControlMesh& mesh = lattice.mesh();
  const EdgeLanes<double> lanes(lattice, x, e, scratch);
  const auto beside = [&](std::size_t h, int k) {
    const Side& side = mesh.sides[std::size_t(mesh.edges[std::size_t(e)].side[h])];
    const double* row = lanes.lane[1 + h] + 3 * k;
    return Corners{{row, row + 3}, mesh.faces[std::size_t(side.face)].quad() ? 2 : 1};
  };
  for (int k = 0; k < lattice.n(); ++k)
    if (is_folded(cut, lanes.lane[0] + 3 * k, lanes.lane[0] + 3 * (k + 1), beside(0, k), beside(1, k)))
      visit(k);
}

bool is_joined(const ControlMesh& mesh, Index e) {
  return !mesh.edges[std::size_t(e)].boundary() && !mesh.feature_edge[std::size_t(e)] &&
         mesh.edge_place(e) != Place::outside;
}

Index face_beside(const ControlMesh& mesh, Index e, std::size_t h) {
  return mesh.sides[std::size_t(mesh.edges[std::size_t(e)].side[h])].face;
}

Folds find_folds(Cut cut, const Lattice& lattice, Workers& workers, const double* x,
                 const std::vector<std::uint8_t>& excused) {
  const ControlMesh& mesh = lattice.mesh();
  const int n = lattice.n();
  Folds folds;
  folds.in_face.assign(mesh.faces.size(), 0);
  folds.on_edge.assign(mesh.edges.size(), 0);
  const auto is_excused = [&](Index f) { return !excused.empty() && excused[std::size_t(f)]; };
  workers.for_parts(mesh.faces.size(), element_grain(n), [&](std::size_t begin, std::size_t end) {
    std::vector<double> closed(3 * closed_size(true, std::size_t(n)));
    for (std::size_t f = begin; f < end; ++f) {
      if (is_excused(Index(f)) || mesh.face_place(Index(f)) != Place::inside) continue;
      gather_face(lattice, x, Index(f), closed.data());
      visit_in_face(cut, mesh.faces[f].quad(), n, closed.data(),
                    [&](LatticePoint, LatticePoint) { ++folds.in_face[f]; });
    }
  });
  workers.for_parts(mesh.edges.size(), element_grain(n) * std::size_t(n),
                    [&](std::size_t begin, std::size_t end) {
                      std::vector<double> scratch;
                      for (std::size_t e = begin; e < end; ++e) {
                        if (!is_joined(mesh, Index(e)) || is_excused(face_beside(mesh, Index(e), 0)) ||
                            is_excused(face_beside(mesh, Index(e), 1)))
                          continue;
                        visit_on_edge(cut, lattice, Index(e), x, scratch, [&](int) { ++folds.on_edge[e]; });
                      }
                    });
  return folds;
}

}  // namespace

std::size_t Folds::count() const {
  std::size_t total = 0;
  for (const std::uint32_t c : in_face) total += c;
  for (const std::uint32_t c : on_edge) total += c;
  return total;
}

Folds find_folds(const Lattice& lattice, Workers& workers, const double* x,
                 const std::vector<std::uint8_t>& excused) {
  return find_folds(Cut::any, lattice, workers, x, excused);
}

std::vector<std::uint8_t> folded_control_faces(const ControlMesh& mesh, std::span<const Vec3> control,
                                               Workers& workers) {
  const Lattice lattice(mesh, 0);
  std::vector<double> x(3 * lattice.size());
  refine_linearly(lattice, control, workers, x.data());
  const Folds folds = find_folds(Cut::every, lattice, workers, x.data(), {});
  std::vector<std::uint8_t> folded(mesh.faces.size(), 0);
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) folded[f] = folds.in_face[f] > 0;
  for (std::size_t e = 0; e < mesh.edges.size(); ++e)
    for (std::size_t h = 0; h < 2 && folds.on_edge[e] > 0; ++h)
      folded[std::size_t(face_beside(mesh, Index(e), h))] = 1;
  return folded;
}

void mark_folds(const Lattice& lattice, const double* x, const Folds& folds, Array<float>& marks) {
  const ControlMesh& mesh = lattice.mesh();
  const int n = lattice.n();
  marks.assign(lattice.size(), 0.0f);
  std::vector<double> scratch(3 * closed_size(true, std::size_t(n)));
  for (Index f = 0; f < Index(mesh.faces.size()); ++f) {
    if (!folds.in_face[std::size_t(f)]) continue;
    gather_face(lattice, x, f, scratch.data());
    visit_in_face(
        Cut::any, mesh.faces[std::size_t(f)].quad(), n, scratch.data(), [&](LatticePoint a, LatticePoint b) {
          marks[std::size_t(lattice.face_point(f, a))] = marks[std::size_t(lattice.face_point(f, b))] = 1;
        });
  }
  for (Index e = 0; e < Index(mesh.edges.size()); ++e)
    if (folds.on_edge[std::size_t(e)])
      visit_on_edge(Cut::any, lattice, e, x, scratch, [&](int k) {
        marks[std::size_t(lattice.edge_point(e, k))] = marks[std::size_t(lattice.edge_point(e, k + 1))] = 1;
      });
}

}  // namespace fairing
