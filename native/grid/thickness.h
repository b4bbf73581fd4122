// SPDX-License-Identifier: GPL-3.0-or-later
// Whether a surface has the thickness of its control mesh.
#pragma once

#include <span>
#include <vector>

#include "grid/grid_level.h"
#include "mesh/opposite.h"
#include "parallel/workers.h"

namespace fairing {

// The change of thickness from the control mesh, or another surface over it, to a surface.
struct ThicknessChange {
  // Control faces behind which the thickness differs from that of the mesh with its edges rounded
  // off: by over a fifth where the mesh is thin, elsewhere by more than the whole thickness. Thicker
  // flat faces, if asked for, by over a twentieth and a fifth. Thicker places count only if they are
  // a fifth of the area.
  std::vector<Index> faces;
  // The largest change among them, in thicknesses of the mesh there; negative: thinner.
  double worst = 0;
  // Control faces with nothing behind them over which the surface rises higher than half a circle
  // across them, and than an arc along them that turns as the faces around do. No thickness tells
  // how far the surface of a sheet may leave its mesh.
  std::vector<Index> bulging;
  // The share of the faired area behind which the thickness changes by more than four thicknesses,
  // or is turned inside out by as much.
  double lost = 0;

  // Most of the surface is unrelated to the mesh.
  bool is_bubble() const { return lost > 0.5; }
};

class Thickness {
 public:
  // `control`: the held positions, one for each control vertex. `mesh` must outlive it.
  Thickness(const ControlMesh& mesh, std::span<const Vec3> control, Workers& workers);

  // The change for the surface x on a level, 3 numbers a point. `of_flats`: flat faces are judged by
  // a finer measure. `wanted`: the surface whose thickness x should have; null: the mesh with its
  // edges rounded off.
  ThicknessChange of(const GridLevel& grid, Workers& workers, const double* x,
                     bool of_flats = false, const double* wanted = nullptr) const;

 private:
  // For each face the move of its centre from its plane, and of the point behind it from the other.
  struct Departures {
    std::vector<double> here, behind;
  };
  Departures departures(const GridLevel& grid, Workers& workers, const double* x) const;

  const ControlMesh& mesh_;
  std::vector<FacePlane> planes_;
  std::vector<double> side_area_, turn_;
  std::vector<Opposite> opposite_;
  double area_ = 0;  // of the faired faces
};

}  // namespace fairing
