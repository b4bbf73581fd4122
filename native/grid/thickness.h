// SPDX-License-Identifier: GPL-3.0-or-later
// Whether a surface is as thick as its control mesh.
#pragma once

#include <span>
#include <vector>

#include "grid/grid_level.h"
#include "mesh/opposite.h"
#include "parallel/workers.h"

namespace fairing {

// Of a surface against its control mesh.
struct ThicknessChange {
  // Control faces behind which the surface has another thickness than the mesh with its edges rounded
  // off: by over a fifth where the mesh is thin, by more than the whole thickness elsewhere. Those
  // behind which it is thicker only where they are a fifth of the area.
  std::vector<Index> faces;
  // The largest change among them, in thicknesses of the mesh there; below zero: thinner.
  double worst = 0;
  // The share of the area that is faired behind which it is by more than four times the thickness, or turned
  // inside out by as much.
  double lost = 0;

  // Most of the surface has little to do with the mesh, whatever the rest.
  bool is_bubble() const { return lost > 0.5; }
};

class Thickness {
 public:
  // `control`: where the surface is held, one position a control vertex. `mesh` must outlive it.
  Thickness(const ControlMesh& mesh, std::span<const Vec3> control, Workers& workers);

  // Of the surface x on a level, 3 numbers a point.
  ThicknessChange of(const GridLevel& grid, Workers& workers, const double* x) const;

 private:
  const ControlMesh& mesh_;
  std::vector<FacePlane> planes_;
  std::vector<Opposite> opposite_;
  double area_ = 0;  // that is faired
};

}  // namespace fairing
