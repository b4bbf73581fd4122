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

// The right-hand side of a surface.
struct PlateData {
  std::span<const Vec3> targets;  // control vertices: fixed at them, or on springs to them
  const FeatureCurves& curves;    // on the finest level
  // The surface of the penalty, on the finest level, if the plate is in the metric of a surface.
  const Array<double>* reference = nullptr;
  // External forces on the finest level, 3 numbers a point, zero at known points; or empty.
  std::span<const double> forces{};
};

// Vectors hold 3 numbers a point of their level. Every solve throws FairingError: cancelled;
// underdetermined if a factorization finds the surface loose, after which the levels are unusable.
class ThinPlateLevels {
 public:
  // All references except `options` must outlive the levels.
  ThinPlateLevels(const ControlMesh& mesh, const Stencils& stencils, Unknowns unknowns,
                  const VertexWeights& weights, const ThinPlateOptions& options, Workers& workers,
                  const Monitor& monitor);
  ThinPlateLevels(const ThinPlateLevels&) = delete;  // its parts refer to each other

  int base() const { return base_; }  // the coarsest level with unknowns worth a solve
  int top() const { return int(grids_.size()) - 1; }
  const GridLevel& grid(int level) const { return *grids_[level]; }
  // r <- (K + P) x without weights, with these control vertices among the unknowns; its diagonal.
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
  // Weights of all points of one level; solves request them on all coarser levels too.
  void set_point_weights(VertexWeights weights, int level) {
    operators_[index(level)]->set_point_weights(std::move(weights));
  }
  const VertexWeights& weights(int level) const { return operators_[index(level)]->weights(); }

  // r <- W c + P reference - (K + P + W) x on the level's unknowns, with c the targets.
  void residual(int level, std::span<const Vec3> targets, const Array<double>& reference,
                const double* x, double* r);
  // Solves from x, whose residual is system.r, to the given limits (Hierarchy::solve).
  LevelSolve solve(int level, const PcgLimits& limits, const LinearSystem& system) {
    return hierarchy_->solve(index(level), limits, system);
  }

  // sums <- H^T r of a level for every control vertex off all curves and inside the region
  // (transfer/level_transfer.h); zero elsewhere, and everywhere if `options` had no pads. Only
  // between solves.
  void restrict_to_vertices(int level, const double* r, std::span<Vec3> sums);

  // Switches the level to the metric of the surface x. Once a level: later surfaces use the same
  // metric, so that they are linear in their data.
  bool is_measured(int level) const { return operators_[index(level)]->is_measured(); }
  void measure(int level, const double* x, const ThinPlateOptions::Penalty& penalty);
  // The penalty's numbers on a level, 1 a point (SurfaceMetric::penalty).
  Array<float> penalty(int level, const Array<float>& finest);
  // The penalty of a level that is measured, per point.
  const Array<float>& penalty(int level) const { return operators_[index(level)]->penalty(); }
  // The reference on a level (thin_plate/surface_rows.h); empty in the control metric.
  Array<double> reference(int level, const PlateData& data);
  // r += P reference, if there is a reference.
  void add_penalty(int level, const Array<double>& reference, double* r) const {
    if (!reference.empty()) operators_[index(level)]->add_penalty(reference.data(), r);
  }

  // The plate's energy with that of tension: what is minimized, without the penalty.
  double bending(int level, const double* x);
  double energy(int level, const double* x);

  // x <- the start of a level: the control polyhedron on the coarsest, the prolongated surface
  // `below` on others.
  void start(int level, const PlateData& data, const Array<double>& below, Array<double>& x);
  // Sets all points that are not unknowns: control vertices, points of curves, the outside of a
  // region.
  void put_fixed(int level, const PlateData& data, double* x) const;

  // The norm of the control polyhedron's residual, to which residuals are relative, and its
  // rounding error. x and r: room for a surface of the level and its residual.
  struct Scales {
    double residual, noise;
  };
  Scales scales(int level, const PlateData& data, const Array<double>& reference, double* x,
                double* r);

 private:
  std::size_t index(int level) const { return std::size_t(level - base_); }  // in the hierarchy

  ThinPlateShared shared_;
  int base_;
  std::vector<std::unique_ptr<GridLevel>> grids_;
  std::vector<std::unique_ptr<ThinPlateLevel>> operators_;  // from base_ on
  QuadraticTransfers<3> transfers_;                         // from 1 on
  Unknowns carried_;                                        // including these control vertices
  std::unique_ptr<Hierarchy> hierarchy_;
};

}  // namespace fairing
