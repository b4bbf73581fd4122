// SPDX-License-Identifier: GPL-3.0-or-later
// One run's surface and everything that the solver needs to move it.
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "curve/feature_curves.h"
#include "energy/thin_plate_level.h"
#include "fair/options.h"
#include "fair/report.h"
#include "solver/hierarchy.h"

namespace fairing {

std::size_t count_unknowns(const Lattice& lattice, const Unknowns& unknowns);

// The thin-plate system of a control mesh on all its levels, in working coordinates. Builds every level once; solves as
// often as weights or control positions change.
class SurfaceSystem {
 public:
  // `curves` are in working coordinates, on the finest level.
  SurfaceSystem(const ControlMesh& mesh, const FeatureCurves& curves, const Stencils& stencils,
                Unknowns unknowns, VertexWeights weights, const FairOptions& options, Workers& workers,
                Monitor& monitor);
  ~SurfaceSystem();

  int base() const { return base_; }  // the coarsest level with unknowns worth a solve
  int top() const { return int(lattices_.size()) - 1; }
  const Lattice& lattice(int level) const { return *lattices_[std::size_t(level)]; }
  ThinPlateShared& shared() { return shared_; }
  Monitor& monitor() { return monitor_; }

  // From here on for another shape: its curves, and the weights to start from. Unless it `adapts`, the smoother stays as it
  // is, so that a surface depends on its own shape alone.
  void take_shape(const FeatureCurves& curves, const VertexWeights& weights, bool adapts);

  // Full multigrid: from the control polyhedron to the solution on the finest level.
  // `targets` are the control vertices: fixed ones stay there, weighted ones are drawn to it.
  // `on_prediction` sees the finest level's start; `on_level` may change weights, and x, after each level's solve.
  void solve_nested(std::span<const Vec3> targets, Array<double>& x, std::vector<LevelReport>& reports,
                    const std::function<void(const double*)>& on_prediction,
                    const std::function<void(int, Array<double>&)>& on_level);

  // From x, a surface of the control positions `before`, to that of `targets` on the finest level, to `tolerance`: the
  // difference first, roughly and level by level.
  void solve_moved(std::span<const Vec3> before, std::span<const Vec3> targets, double tolerance,
                   Array<double>& x, std::vector<LevelReport>& reports,
                   const std::function<void(const double*)>& on_prediction);

  // x <- the start of a level: the control polyhedron on the coarsest, the prolongated x of the level below on others.
  void start_level(int level, std::span<const Vec3> targets, Array<double>& x);

  // A level again, from x as it is.
  LevelReport solve_again(int level, std::span<const Vec3> targets, Array<double>& x, double tolerance);

  // New weights on all levels up to `level`.
  void set_weights(const VertexWeights& weights, int level);

  // residual <- W c - (K + W) x on the level's unknowns.
  void residual(int level, std::span<const Vec3> targets, const double* x, double* r);

  // Puts whatever is no unknown in its place: control vertices, points of curves, all outside a region.
  void set_fixed(int level, std::span<const Vec3> targets, double* x) const;

  double energy(int level, const double* x);

  // The norm of the control polyhedron's residual on a level: what residuals are relative to.
  double reference_residual(int level, std::span<const Vec3> targets) {
    return scales(level, targets).residual;
  }

 private:
  struct Scales {
    double residual, noise;
  };
  Scales scales(int level, std::span<const Vec3> targets);
  LevelReport solve_level(int level, std::span<const Vec3> targets, double tolerance, const Scales& scales,
                          double* x);
  void report_progress(int level, const PcgResult& so_far, double tolerance);
  void add_difference(std::span<const Vec3> before, std::span<const Vec3> targets, Array<double>& x,
                      std::vector<LevelReport>& reports);

  const ControlMesh& mesh_;
  const FeatureCurves* curves_;
  const FairOptions& options_;
  Workers& workers_;
  Monitor& monitor_;
  int weighted_up_to_ = -1;  // the finest level that knows the present weights; -1: all do
  int base_;                 // the coarsest level with unknowns worth a solve
  Hierarchy hierarchy_;
  std::vector<std::unique_ptr<Lattice>> lattices_;
  ThinPlateShared shared_;
  std::vector<std::unique_ptr<ThinPlateLevel>> operators_;  // from base_ on
  std::vector<std::unique_ptr<ThinPlateTransfer>> transfers_;
  Array<double> below_;  // the level below a start
  // Of solve_moved.
  std::vector<Vec3> moved_;
  FeatureCurves moved_curves_;
  Array<double> difference_;
};

}  // namespace fairing
