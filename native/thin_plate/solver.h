// SPDX-License-Identifier: GPL-3.0-or-later
// The thin plate's linear system on all levels, and the order in which they are solved: full
// multigrid from the control polyhedron, or from an earlier surface.
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "curves/feature_curves.h"
#include "hold/couples.h"
#include "hold/pads.h"
#include "parallel/monitor.h"
#include "thin_plate/level.h"
#include "thin_plate/options.h"
#include "transfer/level_transfer.h"

namespace fairing {

class HoldInSpace;

// What holds a surface's control vertices.
struct HeldState {
  Loads loads;                          // on the pads; empty without
  Moments moments;                      // of the couples that fix normals
  Loads forces{};                       // left at the control vertices on pads
  Loads coarse_forces{};                // of the hats on the level below a start; or empty
  const HoldInSpace* placed = nullptr;  // what has placed vertices, while they are
  std::vector<Vec3> pulls{};            // by which these are held
};

// The thin-plate system of a control mesh on all its levels, in working coordinates. Builds every
// level once; solves as often as weights or control positions change.
//
// Vectors hold 3 numbers a point of their level; `targets` are one a control vertex. Whatever
// solves throws FairingError: cancelled where `monitor` says so, underdetermined where a factor
// finds that the surface is loose. Then only a new solver is of use.
class ThinPlateSolver {
 public:
  // `curves` are in working coordinates, on the finest level; `charts` are those of the stencils.
  // All references but to charts and options must outlive the solver.
  ThinPlateSolver(const ControlMesh& mesh, const FeatureCurves& curves, const ChartMaker& charts,
                  const Stencils& stencils, Unknowns unknowns, VertexWeights weights,
                  const ThinPlateOptions& options, Workers& workers, Monitor& monitor);
  ~ThinPlateSolver();

  int base() const { return base_; }  // the coarsest level with unknowns worth a solve
  int top() const { return int(grids_.size()) - 1; }
  const GridLevel& grid(int level) const { return *grids_[std::size_t(level)]; }
  // Between a level and the one below; null where passes serve, and on the coarsest.
  const AssembledTransfer* transfer_matrix(int level) const {
    return level > base_ ? transfer_matrices_[std::size_t(level - base_ - 1)].get() : nullptr;
  }
  ThinPlateShared& shared() { return shared_; }
  Monitor& monitor() { return monitor_; }

  // From here on for another shape: its curves, and the weights to start from. Unless it `adapts`,
  // the smoother stays as it is, so that a surface depends on its own shape alone.
  void take_shape(const FeatureCurves& curves, const VertexWeights& weights, bool adapts);

  // Full multigrid: from the control polyhedron to the solution on the finest level.
  // `targets` are the control vertices: fixed ones stay there, weighted ones are drawn to it.
  // `constraint`, which may be null, chooses the weights on each level. `on_prediction` sees the
  // finest level's start; `on_level` may change x after each level's solve.
  void solve_nested(std::span<const Vec3> targets, Array<double>& x,
                    std::vector<LevelReport>& reports,
                    const std::function<void(const double*)>& on_prediction,
                    const std::function<void(int, Array<double>&)>& on_level,
                    HoldInSpace* constraint = nullptr);

  // From x, a surface of the control positions `before`, to that of `targets` on the finest level,
  // to `tolerance`: the difference first, roughly and level by level.
  void solve_moved(std::span<const Vec3> before, std::span<const Vec3> targets, double tolerance,
                   Array<double>& x, std::vector<LevelReport>& reports,
                   const std::function<void(const double*)>& on_prediction);

  // A copy of what x holds of the level below, where there is one; x gets room for the finest
  // level.
  const Array<double>& surface_below(int level, Array<double>& x);
  // x <- the start of a level: the control polyhedron on the coarsest, the prolongated surface
  // below on others; without loads and couples.
  void start_level(int level, std::span<const Vec3> targets, const Array<double>& below,
                   Array<double>& x);

  // A level again, from x as it is.
  LevelReport solve_again(int level, std::span<const Vec3> targets, Array<double>& x,
                          double tolerance);

  // New weights on all levels up to `level`.
  void set_weights(const VertexWeights& weights, int level);

  // residual <- W c - (K + W) x on the level's unknowns.
  void residual(int level, std::span<const Vec3> targets, const double* x, double* r);

  // Puts whatever is no unknown in its place: control vertices, points of curves, all outside a
  // region.
  void set_fixed(int level, std::span<const Vec3> targets, double* x) const {
    set_fixed(level, targets, *curves_, x);
  }

  // The plate's own energy, and with tension's: what is minimized.
  double bending(int level, const double* x);
  double energy(int level, const double* x);

  // On the pads, of the surface that was solved for last; empty without pads.
  Loads& loads() { return held_.loads; }
  // Null without.
  const Pads* pads() const { return pads_.get(); }
  // What fixes normals; null where none is.
  const Couples* couples() const { return couples_.get(); }
  const Moments& moments() const { return held_.moments; }

  // The norm of the control polyhedron's residual on a level: what residuals are relative to.
  double reference_residual(int level, std::span<const Vec3> targets) {
    Array<double> polyhedron(3 * grid(level).size());
    return scales(level, targets, polyhedron.data()).residual;
  }

 private:
  struct Scales {
    double residual, noise;
  };
  // x: room for a surface.
  Scales scales(int level, std::span<const Vec3> targets, double* x);
  PcgLimits limits_of(double tolerance, const Scales& scale, double energy_scale) const;
  // `constraint` may be null.
  LevelReport solve_level(int level, std::span<const Vec3> targets, const PcgLimits& limits,
                          HoldInSpace* constraint, HeldState& held, double* x);
  // On pads, within tolerances or with fixed normals (solve_in_rounds.cpp).
  struct Rounds;
  LevelReport solve_in_rounds(int level, std::span<const Vec3> targets, const PcgLimits& limits,
                              HoldInSpace* constraint, HeldState& held, double* x);
  // What holds the plate, before those rounds (forces.cpp).
  void take_pulls(const double* r, HeldState& held) const;
  void residual_on_pads(int level, std::span<const Vec3> targets, const double* x, HeldState& held,
                        double* r);
  // Those of a level, from those of the one below; `foretells` how they change.
  void start_held(int level, bool foretells, HeldState& held);
  void start_loads(int level, bool foretells, HeldState& held);
  // Where x has been thrown off the mesh, point forces take the place of pads. Whether any has.
  bool leave_thrown_pads(int level, std::span<const Vec3> targets, const double* x);
  // Whether couples fix normals on a level: not where hats have no points.
  bool has_couples(int level) const {
    return couples_ && level >= std::min(Couples::first_level, top());
  }
  void start_couples(int level, Moments& moments);
  void measure_couples(int level);
  void report_progress(int level, const PcgResult& so_far, double tolerance);
  void report_done(int level, double done);  // of the finest level's solve, from 0 to 1
  void set_fixed(int level, std::span<const Vec3> targets, const FeatureCurves& curves,
                 double* x) const;
  // What moves points of curves from where x has them to where they are to be.
  FeatureCurves moves_of_curves(const Array<double>& x) const;
  void add_difference(std::span<const Vec3> before, std::span<const Vec3> targets, Array<double>& x,
                      std::vector<LevelReport>& reports);

  const ControlMesh& mesh_;
  const FeatureCurves* curves_;
  ThinPlateOptions options_;
  Workers& workers_;
  Monitor& monitor_;
  int weighted_up_to_ = -1;  // the finest level that knows the present weights; -1: all do
  int base_;                 // the coarsest level with unknowns worth a solve
  Hierarchy hierarchy_;
  std::vector<std::unique_ptr<GridLevel>> grids_;
  ThinPlateShared shared_;
  std::vector<std::unique_ptr<ThinPlateLevel>> operators_;  // from base_ on
  std::vector<std::unique_ptr<AssembledTransfer>> transfer_matrices_;
  std::vector<std::unique_ptr<QuadraticTransfer<3>>> transfers_;
  std::unique_ptr<Pads> pads_;  // null: control vertices are held by point forces
  // Of the surface at each control vertex, K's diagonal on level 0; empty where none moves.
  std::vector<double> stiffness_;
  std::unique_ptr<Couples> couples_;  // null: no normal is fixed
  HeldState held_;                    // of the surface that was solved for last
  LevelSolve equivalent_solve_;       // what one in place of a level's many would have taken
  Array<double> below_;               // the level below a start
  PcgLimits finest_limits_;           // of the last surface that was solved from nothing
};

}  // namespace fairing
