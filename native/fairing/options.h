// SPDX-License-Identifier: GPL-3.0-or-later
// Every setting of fair() and FairSolver, with its default, unit and range. A new setting goes
// here or into the options of its folder (`membrane`, `solve`, `paper`, `features`), into the table
// in settings.h, into the package's (discrete_fairing/options.py), and as a row into
// docs/python/fair.md.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "curves/curve.h"
#include "fairing/whole.h"
#include "mesh/control_mesh.h"
#include "mesh/polygon_mesh.h"
#include "mesh/sharpness.h"
#include "multigrid/solve_options.h"
#include "paper/options.h"
#include "stencil/chart.h"
#include "stencil/membrane.h"

namespace fairing {

// Control vertices stay, move within a tolerance or against weights, or are replaced by their limit
// positions under Catmull-Clark subdivision (mesh/catmull_clark.h).
enum class Interpolation { exact, approximate, limit };

// The quantity to minimise.
enum class Energy {
  // Second derivatives over charts of the control mesh: one linear system [Kobbelt 1997a, §4].
  thin_plate,
  // The integral of k1^2 + k2^2 over the surface itself, by Gauss-Newton steps from the thin
  // plate's surface.
  total_curvature,
  // The change of curvature along the surface [Moreton, Sequin 1992], by steps likewise.
  minimum_variation,
};

// What happens to a mesh with defects.
enum class Repair {
  refuse,  // refuse the mesh
  mend,    // repair what can be repaired (mesh/mend/mend.h), and flip faces
};

// Refinements of a control face: 4^15 triangles each.
constexpr int most_levels = 15;

struct FairOptions {
  // How often each control face is split into four; 0 to most_levels.
  int levels = 3;
  Energy energy = Energy::thin_plate;
  // Gauss-Newton steps end below this estimated remaining movement, as a share of the mesh's size;
  // 0 to 0.1. 0: from `relative_residual`.
  double step_tolerance = 0;
  double step_tolerance_wanted() const;
  // The most Gauss-Newton steps on the finest level; at least 1.
  int max_steps = 20;
  // Exponent of the control edge lengths in the charts; 0 to 1.
  double metric_exponent = centripetal;
  // Of borders and creases. Limit positions ask for the ends that the subdivision surface has.
  CurveScheme curve_scheme() const;
  FeatureOptions features;
  Repair repair = Repair::refuse;
  // Mending merges vertices no farther apart than this, in mesh units. 0: only vertices at one
  // point; negative: none.
  double weld = -1;

  Interpolation interpolation = Interpolation::exact;
  // Approximate: the farthest that a control vertex may move, in mesh units. One number for all,
  // where 0 means no tolerance (weights alone hold); or one for each vertex, where 0 fixes it and
  // infinity leaves it to its weight.
  std::vector<double> tolerance{0.0};
  // Approximate: one for each vertex, or empty. 0 frees a vertex that has no tolerance; infinity
  // fixes it.
  std::vector<double> weights;
  // Limit: how closely the surface follows the subdivision surface between the limit positions,
  // 0 to 1; and which edges and vertices are semi-sharp.
  double limit = 1;
  Sharpness sharpness;

  // Width of the pads that hold control vertices off curves (constraints/pads.h), as a share of the
  // faces around the vertex; 0 to 1. 0: point forces.
  double pad_size = 1;
  double width_of_pads() const { return paper.needs_point_forces() ? 0.0 : pad_size; }

  // The surface's normal at each input vertex, 3 numbers each, of any length; zeros or NaN leave it
  // free. Empty: all free. For the thin plate, off curves and inside the region, from level 1 on.
  std::vector<double> normals;
  // Whether input vertex v has a normal; whether any has.
  bool has_normal(std::size_t v) const;
  bool has_normals() const;

  MembraneOptions membrane;

  // For a piece of a larger mesh: data of the whole (fairing/outline.h). Not a setting.
  OfWhole whole{};

  // Further positions of all vertices, shape after shape, 3 numbers a vertex. The caller owns them.
  std::span<const double> shapes{};
  // `coordinates`: numbers per shape.
  std::size_t shape_count(std::size_t coordinates) const {
    return coordinates ? shapes.size() / coordinates : 0;
  }
  // How far input vertex v may move, in mesh units; infinity: only its weight holds it.
  double tolerance_of(std::size_t v) const;
  // Whether any vertex has a finite, nonzero tolerance.
  bool has_tolerance() const;

  SolveOptions solve;

  // 0: all cores. The result does not depend on it.
  int threads = 0;
  // Bytes; 0: three quarters of the machine's memory.
  std::size_t memory_limit = 0;
  std::size_t bytes_allowed() const;
  // Whether to measure the energies of result, control polyhedron and prediction.
  bool measure = false;

  PaperOptions paper;
};

// The factor of the penalty on the distance from the subdivision surface, relative to the
// bending (grid/limit_surface.h), from FairOptions::limit.
double limit_penalty(double limit);

// Throws FairingError(bad_option), naming the option and its range.
void check_options(const PolygonMesh& mesh, const FairOptions& options);

}  // namespace fairing
