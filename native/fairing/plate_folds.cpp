// SPDX-License-Identifier: GPL-3.0-or-later
#include "fairing/plate_folds.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/roundoff.h"
#include "curvature/fold_repair.h"
#include "curvature/local_damping.h"
#include "grid/linear.h"

namespace fairing {
namespace {

// Vertices with weights or tolerances keep their positions.
Unknowns points_to_fill(const FairingProblem& problem) {
  Unknowns unknowns = problem.unknowns;
  if (problem.options.interpolation == Interpolation::approximate)
    std::fill_n(unknowns.vertex.begin(), problem.mesh.first_centre(), std::uint8_t(0));
  return unknowns;
}

class PlateFoldRepair {
 public:
  PlateFoldRepair(const FairingProblem& problem, const ControlPositions& control,
                  const GridLevel& grid)
      : mesh_(problem.mesh),
        workers_(*problem.workers),
        curves_(control.working_curves),
        grid_(grid),
        control_(control.working),
        unknowns_(points_to_fill(problem)),
        polyhedron_(3 * grid.size()) {
    refine_linearly(grid_, control_, workers_, polyhedron_.data());
  }

  PlateRepair run(Array<double>& surface) {
    const std::vector<std::uint8_t> excused =
        folded_control_faces(mesh_, control_, workers_, std::cos(steepest));
    const auto find = [&] { return find_folds(grid_, workers_, surface.data(), excused); };
    Folds folds = find();
    PlateRepair repair;
    if (folds.count() == 0) return repair;
    repair.filled.assign(grid_.size(), 0.0f);
    const Array<double> plate = surface;
    Array<float> marks;
    std::size_t before = folds.count();
    // a quarter farther each time, up to two control faces: at a re-entrant corner the plate
    // overtakes itself in both faces beside it
    for (int rings = 2; rings <= 2 * grid_.n() && folds.count() > 0; rings += 1 + rings / 4) {
      mark_folds(grid_, surface.data(), folds, marks);
      if (rings > 2 && folds.count() >= before)
        straighten_near(surface, marks, repair.straightened);
      before = folds.count();
      dilate_by(rings, marks);
      for (std::size_t i = 0; i < marks.size(); ++i)
        repair.filled[i] = std::max(repair.filled[i], marks[i]);
      unmark(excused, repair.filled);
      unmark(mesh_.flat.face, repair.filled);  // their stiffness holds their points in the plane
      surface = plate;
      apply(repair, polyhedron_, surface);
      folds = find();
    }
    if (count_all(surface) < count_all(plate)) return repair;
    surface = plate;
    return {};
  }

  // What is filled is the distance from the polyhedron: filled as a whole, the surface is the
  // polyhedron, without folds. `shape`: for the weights.
  void apply(const PlateRepair& repair, const Array<double>& shape, Array<double>& surface) {
    for (const Index e : repair.straightened)
      std::copy_n(polyhedron_.begin() + first_number(e), 3 * inner(),
                  surface.begin() + first_number(e));
    Array<double> off(surface.size());
    for (std::size_t i = 0; i < off.size(); ++i) off[i] = surface[i] - polyhedron_[i];
    fill_harmonically(grid_, unknowns_, repair.filled, shape.data(), off.data());
    // others stay bit for bit
    for (std::size_t i = 0; i < off.size(); ++i)
      surface[i] += off[i] - (surface[i] - polyhedron_[i]);
  }

 private:
  std::size_t inner() const { return std::size_t(grid_.n() - 1); }  // points of an edge
  std::ptrdiff_t first_number(Index e) const { return 3 * std::ptrdiff_t(grid_.edge_base(e)); }

  // Whether the curve is its control edge.
  bool is_straight(const Array<double>& surface, Index e) const {
    const auto& [from, to] = mesh_.edges[e].vertex;
    const double length = (control_[to] - control_[from]).norm();
    const auto is_near = [&](double a, double b) { return std::abs(a - b) <= roundoff * length; };
    const auto own = surface.begin() + first_number(e);
    return std::equal(own, own + 3 * std::ptrdiff_t(inner()), polyhedron_.begin() + first_number(e),
                      is_near);
  }

  // Including those of the control mesh.
  std::size_t count_all(const Array<double>& surface) const {
    return find_folds(grid_, workers_, surface.data(), {}).count();
  }

  // For closed faces: next to folds of the control mesh no orientation is right.
  void unmark(const std::vector<std::uint8_t>& faces, Array<float>& marks) const {
    const int n = grid_.n();
    for (Index f = 0; f < Index(faces.size()); ++f) {
      if (!faces[f]) continue;
      const bool quad = mesh_.faces[f].quad();
      for (int j = 0; j <= n; ++j)
        for (int i = 0; i <= (quad ? n : n - j); ++i) marks[grid_.face_point(f, i, j)] = 0;
    }
  }

  void dilate_by(int rings, Array<float>& marks) {
    for (int r = 0; r < rings; ++r) dilate(grid_, workers_, slots_, nullptr, marks);
  }

  // Marks the points of curves near a marked point, and adds the edges that they leave.
  void straighten_near(const Array<double>& surface, Array<float>& marks,
                       std::vector<Index>& edges) {
    Array<float> near = marks;
    dilate_by(1, near);
    const auto begin = [&](auto& of, Index e) { return of.begin() + grid_.edge_base(e); };
    std::vector<std::uint8_t> is_near(curves_.points.size(), 0);  // by run
    const auto run = [&](Index e) { return std::size_t(curves_.run[e]); };
    for (const Index e : on_curves())
      if (std::any_of(begin(near, e), begin(near, e) + std::ptrdiff_t(inner()),
                      [](float mark) { return mark > 0; }))
        is_near[run(e)] = 1;
    for (const Index e : on_curves()) {
      if (!is_near[run(e)] || std::exchange(is_marked_[e], 1)) continue;
      std::fill_n(begin(marks, e), inner(), 1.0f);
      if (!is_straight(surface, e)) edges.push_back(e);
    }
  }

  std::vector<Index> on_curves() const {
    std::vector<Index> edges;
    for (std::size_t e = 0; e < curves_.run.size() && inner() > 0; ++e)
      if (curves_.run[e] >= 0) edges.push_back(Index(e));
    return edges;
  }

  const ControlMesh& mesh_;
  Workers& workers_;
  const FeatureCurves& curves_;
  const GridLevel& grid_;
  std::span<const Vec3> control_;
  Unknowns unknowns_;
  Array<double> polyhedron_;
  std::vector<std::uint8_t> is_marked_ = std::vector<std::uint8_t>(mesh_.edges.size(), 0);
  ElementSlots<float, 1> slots_;
};

}  // namespace

PlateRepair repair_plate_folds(const FairingProblem& problem, const ControlPositions& control,
                               const GridLevel& grid, Array<double>& surface) {
  return PlateFoldRepair(problem, control, grid).run(surface);
}

void apply_plate_repair(const FairingProblem& problem, const ControlPositions& control,
                        const GridLevel& grid, const PlateRepair& repair, Array<double>& surface) {
  Array<double> shape(surface.size());
  refine_linearly(grid, problem.basis.working, *problem.workers, shape.data());
  PlateFoldRepair(problem, control, grid).apply(repair, shape, surface);
}

}  // namespace fairing
