// SPDX-License-Identifier: GPL-3.0-or-later
// The thin plate's linear system on all levels of a control mesh, in working coordinates: grids,
// operators, transfers, and the hierarchy that solves on any of them.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "curves/feature_curves.h"
#include "parallel/monitor.h"
#include "thin_plate/level.h"
#include "thin_plate/options.h"
#include "transfer/level_transfer.h"

namespace fairing {

// What a surface is to come up to.
struct PlateData {
  std::span<const Vec3> targets;  // control vertices: fixed ones stay there, others are drawn there
  const FeatureCurves& curves;    // on the finest level
  // Where the plate is drawn to, on the finest level, where it is in the metric of a surface.
  const Array<double>* goal = nullptr;
};

// Vectors hold 3 numbers a point of their level. Whatever solves throws FairingError: cancelled
// where the run is, underdetermined where a factor finds that the surface is loose. Then only new
// levels are of use.
class ThinPlateLevels {
 public:
  // All references but to `options` must outlive the levels.
  ThinPlateLevels(const ControlMesh& mesh, const Stencils& stencils, Unknowns unknowns,
                  const VertexWeights& weights, const ThinPlateOptions& options, Workers& workers,
                  const Monitor& monitor);
  ThinPlateLevels(const ThinPlateLevels&) = delete;  // its parts refer to each other

  int base() const { return base_; }  // the coarsest level with unknowns worth a solve
  int top() const { return int(grids_.size()) - 1; }
  const GridLevel& grid(int level) const { return *grids_[std::size_t(level)]; }
  // Between a level and the one below; null where passes serve, and on the coarsest.
  const AssembledTransfer* transfer_matrix(int level) const {
    return level > 0 ? transfer_matrices_[std::size_t(level - 1)].get() : nullptr;
  }
  // r <- (K + P) x without weights, where these control vertices count as unknowns; its diagonal.
  void apply_with(int level, const Unknowns& unknowns, const double* x, double* r) {
    operators_[index(level)]->apply_with(unknowns, x, r);
  }
  Array<float> diagonal_with(int level, const Unknowns& unknowns) {
    return operators_[index(level)]->diagonal_with(unknowns);
  }
  LevelOperator& op(int level) { return *operators_[index(level)]; }
  ThinPlateShared& shared() { return shared_; }
  const ThinPlateShared& shared() const { return shared_; }
  Workers& workers() { return shared_.workers; }
  Hierarchy& hierarchy() { return *hierarchy_; }
  std::size_t unknowns_of(int level) const { return count_unknowns(grid(level), shared_.unknowns); }

  // New weights of control vertices, on all levels up to `level`.
  void set_weights(const VertexWeights& weights, int level);
  // Weights of all points of one level; solves ask for them on all levels below, too.
  void set_point_weights(VertexWeights weights, int level) {
    operators_[index(level)]->set_point_weights(std::move(weights));
  }
  const VertexWeights& weights(int level) const { return operators_[index(level)]->weights(); }

  // r <- W c + P goal - (K + P + W) x on the level's unknowns, with c the targets.
  void residual(int level, std::span<const Vec3> targets, const Array<double>& goal,
                const double* x, double* r);
  // Solves from x, of which system.r is the residual, to the limits given (Hierarchy::solve).
  LevelSolve solve(int level, const PcgLimits& limits, const LinearSystem& system,
                   const std::function<void(const PcgResult&)>& each) {
    return hierarchy_->solve(index(level), limits, system, each);
  }

  // sums <- H^T r of a level for every control vertex off all curves and inside the region
  // (transfer/level_transfer.h). Zero elsewhere, and always where `options` had no pads. Between
  // solves only.
  void restrict_to_vertices(int level, const double* r, std::span<Vec3> sums);

  // From here on the level is in the metric of the surface x. Once a level: later surfaces are in the
  // same, so that they are linear in what they are to come up to.
  bool is_measured(int level) const { return operators_[index(level)]->is_measured(); }
  void measure(int level, const double* x, const ThinPlateOptions::Pull& pull);
  // The goal on a level (thin_plate/surface_differences.h); empty in the control metric.
  Array<double> goal(int level, const PlateData& data);
  // r += P goal, where there is one.
  void add_pull(int level, const Array<double>& goal, double* r) const {
    if (!goal.empty()) operators_[index(level)]->add_pull(goal.data(), r);
  }

  // The plate's own energy, and with tension's: what is minimized, but for the pull.
  double bending(int level, const double* x);
  double energy(int level, const double* x);

  // x <- the start of a level: the control polyhedron on the coarsest, the prolongated surface
  // `below` on others.
  void start(int level, const PlateData& data, const Array<double>& below, Array<double>& x);
  // Puts whatever is no unknown in its place: control vertices, points of curves, all outside a
  // region.
  void put_fixed(int level, const PlateData& data, double* x) const;

  // The norm of the control polyhedron's residual, to which residuals are relative, and what
  // rounding leaves of it. x and r: room for a surface of the level, and its residual.
  struct Scales {
    double residual, noise;
  };
  Scales scales(int level, const PlateData& data, const Array<double>& goal, double* x, double* r);

 private:
  std::size_t index(int level) const { return std::size_t(level - base_); }  // in the hierarchy

  ThinPlateShared shared_;
  int base_;
  std::vector<std::unique_ptr<GridLevel>> grids_;
  std::vector<std::unique_ptr<ThinPlateLevel>> operators_;             // from base_ on
  std::vector<std::unique_ptr<AssembledTransfer>> transfer_matrices_;  // from 1 on
  QuadraticTransfers<3> transfers_;
  Unknowns carried_;  // to control vertices: these too
  std::unique_ptr<Hierarchy> hierarchy_;
};

}  // namespace fairing
