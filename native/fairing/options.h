// SPDX-License-Identifier: GPL-3.0-or-later
// Every setting of fair() and FairSolver, with its default, unit and range. A new setting goes here,
// into the table beside (settings.h), and into the package's (discrete_fairing/options.py).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "fairing/whole.h"
#include "mesh/control_mesh.h"
#include "mesh/polygon_mesh.h"
#include "mesh/sharpness.h"
#include "multigrid/solve_options.h"
#include "paper/options.h"
#include "stencil/chart.h"

namespace fairing {

// Whether control vertices stay, move within a tolerance or against weights, or go to where
// Catmull-Clark subdivision would take them (mesh/catmull_clark.h) and stay there.
enum class Interpolation { exact, approximate, limit };

// The quantity to minimise.
enum class Energy {
  // Second derivatives over charts of the control mesh: one linear system [Kobbelt 1997a, §4].
  thin_plate,
  // The integral of k1^2 + k2^2 over the surface itself: Gauss-Newton steps from the thin plate's
  // surface.
  total_curvature,
  // The change of curvature along the surface [Moreton, Sequin 1992]: likewise.
  minimum_variation,
};

// What happens to a mesh with defects.
enum class Repair {
  refuse,  // it is refused
  mend,  // those that can be mended are (mesh/mend/mend.h), and faces that look the wrong way turn
};

// Refinements of a control face: 4^15 triangles each.
constexpr int most_levels = 15;

struct FairOptions {
  // How often each control face is split into four; 0 to most_levels.
  int levels = 3;
  Energy energy = Energy::thin_plate;
  // Gauss-Newton steps end where less is left to move, as a share of the mesh's size; 0 to 0.1, with
  // 0 for what goes with `relative_residual`.
  double step_tolerance = 0;
  double step_tolerance_wanted() const;
  // The most Gauss-Newton steps on the finest level; at least 1.
  int max_steps = 20;
  // Charts are made from control edge lengths to this power, 0 to 1.
  double metric_exponent = centripetal;
  FeatureOptions features;
  Repair repair = Repair::refuse;
  // Mending: vertices no farther apart than this become one, mesh units; 0: those at one point;
  // negative: none.
  double weld = -1;

  Interpolation interpolation = Interpolation::exact;
  // Approximate: the farthest that a control vertex may move, in mesh units. One number for all,
  // with 0 for none: weights alone hold. Or one a vertex: 0 fixes it, infinity leaves it to its
  // weight.
  std::vector<double> tolerance{0.0};
  // Approximate: one a vertex, or empty. 0 frees a vertex that has no tolerance, infinity fixes it.
  std::vector<double> weights;
  // Limit: how closely the thin plate follows the subdivision surface between the limit positions: 0,
  // not at all, to 1; and which edges and vertices are semi-sharp on the way.
  double limit = 1;
  Sharpness sharpness;

  // What holds control vertices off curves: point forces at 0, otherwise forces spread over pads of
  // this width (constraints/pads.h), as a share of the faces around the vertex; 0 to 1.
  double pad_size = 1;
  double width_of_pads() const { return paper.needs_point_forces() ? 0.0 : pad_size; }

  // Which normal the surface has at each input vertex, 3 numbers each, of any length; none where they
  // are zero or one is NaN. Empty: nowhere. For the thin plate, off curves and inside the region; the
  // coarsest level has nothing to turn.
  std::vector<double> normals;
  // Whether there is a normal at input vertex v, and at any.
  bool has_normal(std::size_t v) const;
  bool has_normals() const;

  // A membrane stretched over the mesh, against swelling and overshoots: none at 0, as taut as is of
  // use at 1 (membrane_strength()).
  double tension = 0;

  // Where the mesh is a piece: what it takes from the whole (fairing/outline.h). No setting.
  OfWhole whole{};

  // Further positions of all vertices, shape after shape, 3 numbers a vertex. The caller owns them.
  std::span<const double> shapes{};
  // `coordinates`: how many numbers one shape has.
  std::size_t shape_count(std::size_t coordinates) const {
    return coordinates ? shapes.size() / coordinates : 0;
  }
  // How far input vertex v may move, in mesh units; infinity: only weights hold it.
  double tolerance_of(std::size_t v) const;
  // Whether any vertex may move, and only so far.
  bool has_tolerance() const;

  SolveOptions solve;

  // 0: one a core. The result is the same for any number.
  int threads = 0;
  // Bytes; 0: three quarters of the machine's memory.
  std::size_t memory_limit = 0;
  std::size_t bytes_allowed() const;
  // Whether to measure the energies of result, control polyhedron and prediction.
  bool measure = false;

  PaperOptions paper;
};

// What the membrane's energy is multiplied by, relative to bending over the length of a control edge
// (stencil/membrane.h), for FairOptions::tension.
double membrane_strength(double tension);

// What the plate is drawn to the subdivision surface with, relative to its own bending
// (grid/limit_surface.h), for FairOptions::limit.
double pull_to_limits(double limit);

// Throws FairingError(bad_option), naming the option and its range.
void check_options(const PolygonMesh& mesh, const FairOptions& options);

}  // namespace fairing
